#pragma once
#include "evert/contact/keyframed_motion.hpp"
#include "evert/core/number_array.hpp"
#include "evert/filter/filter_constraints.hpp"
#include "evert/filter/selection.hpp"
#include "evert/forces/mass_form.hpp"
#include "evert/integrators/method.hpp"
#include "evert/materials/damping.hpp"
#include "evert/materials/lame.hpp"
#include "evert/math/vec3.hpp"
#include "evert/mesh/bad_meshes.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/round_bar.hpp"
#include "evert/scene/shape_config.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// A scene as plain values, SI units, already checked: what scene/load.hpp makes and scene/build.hpp turns
/// into objects. Keys, units, ranges and help stand in the tables of src/scene/*_table.cpp, and only there.
/// A feature that the scene does not name is an empty optional or an empty list.
namespace evert {

// --- the mesh of a body

/// A mesh file; the format is known by its content and ending.
struct FileMesh {
  std::string path;                 ///< relative ones are relative to the scene file; resolved here
  std::vector<std::string> groups;  ///< named volume groups to keep; empty: all
};

struct BoxMesh {
  Vec3d size{};  ///< [m] max − min
  Vec3d min{};   ///< [m]
  Vec3d max{};   ///< [m]
  BoxCells cell = BoxCells::bcc;
  std::array<int, 3> cells{};  ///< along x, y, z; all 0 when edge_length is given
  std::array<int, 2> hole{};   ///< cubes left out in the middle along x, y; 0 without a hole
  int cross = 0;               ///< cubes that the bars of a cross are thick; 0 without
  double edge_length = 0;      ///< [m]; 0 when cells are given
};

/// Any shape that has an end, filled with tetrahedra.
struct FilledShape {
  SolidConfig solid;
  double edge_length = 0;  ///< [m]
};

using MeshConfig = std::variant<FileMesh, BoxMesh, FilledShape, RoundBar, WedgeStack, CutCube, SliverBall>;

// --- bodies

/// Makes the rest shape and places it in the world: fit, then scale, then rotate, then translate.
struct TransformConfig {
  std::optional<double> fit;  ///< [m] centre the bounding box at the origin, make its longest side this long
  double scale = 1;           ///< [-] > 0
  std::optional<RotationConfig> rotate;
  Vec3d translate{};  ///< [m]
};

enum class StartKind { none, scramble, flatten_plane, flatten_line, flatten_point, inside_out };

/// Where the nodes start: (1 − amplitude)·rest + amplitude·target, target being a random point of the
/// bounding box (scramble), the projection onto a plane, line or point through the centre of the bounding
/// box, or the point mirrored at that plane (inside_out).
struct StartConfig {
  StartKind kind = StartKind::scramble;  ///< never none: then the whole optional is empty
  double amplitude = 1;                  ///< [-] > 0
  Vec3d axis{{0, 1, 0}};                 ///< unit vector: normal of the plane, direction of the line
  std::uint64_t seed = 1;  ///< of scramble; the target of a node depends on the seed and its number only
};

enum class MaterialModel {
  neo_hookean,
  rotated_linear,
  st_venant_kirchhoff,
  mooney_rivlin,
  spline,
  stable_neo_hookean,
  muscle,
  tendon
};

/// Moduli in exactly one way: (E, ν), (λ, μ), or with mooney_rivlin, and with muscle and tendon, whose matrix
/// it is, (μ10, μ01, κ). What is empty of the rest
/// is the model's own default, or does not go with the model.
struct MaterialConfig {
  MaterialModel model = MaterialModel::neo_hookean;
  std::optional<double> youngs_modulus;          ///< [Pa] ≥ 0
  std::optional<double> poissons_ratio;          ///< [-] in (−1, 0.5)
  std::optional<double> lambda;                  ///< [Pa] > −2μ/3
  std::optional<double> mu;                      ///< [Pa] > 0
  std::optional<double> mu_10;                   ///< [Pa] ≥ 0
  std::optional<double> mu_01;                   ///< [Pa] ≥ 0, not 0 with mu_10
  std::optional<double> bulk_modulus;            ///< [Pa] > 0
  std::optional<double> mu_01_share;             ///< [-] in [0, 1]
  std::optional<double> compression_limit;       ///< [-] in (0, 1); in [0, 1] for spline
  std::optional<double> elongation_limit;        ///< [-] ≥ 1
  std::optional<double> compression_stiffening;  ///< [-] > 0
  std::optional<double> elongation_stiffening;   ///< [-] > 0
  Extension extension = Extension::linear;
  std::optional<double> peak_stress;       ///< [Pa] ≥ 0
  std::optional<double> passive_factor;    ///< [-] ≥ 0
  std::optional<double> passive_exponent;  ///< [-] > 0
  std::optional<double> passive_limit;     ///< [-] ≥ 1
  std::optional<double> active_width;      ///< [-] in (0, 1)
};

/// Directions of the fibres of a body at rest. Constant ones and curves stand in the world, after the body's
/// transform; those of the mesh file turn with it.
struct ConstantFibres {
  Vec3d direction{{1, 0, 0}};  ///< unit vector
};
/// Vectors of any length per cell of the mesh file.
struct FieldFibres {
  std::string field;
};
/// Each cell takes the direction of the nearest segment of a polyline.
struct CurveFibres {
  std::vector<Vec3d> curve;  ///< [m] at least two points, no two in a row alike
};
using FibreConfig = std::variant<ConstantFibres, FieldFibres, CurveFibres>;

struct ActivationKey {
  double time = 0;   ///< [s]
  double value = 0;  ///< [-] in [0, 1]
};
/// Linear in between, constant outside; times strictly increasing; never empty.
using ActivationConfig = std::vector<ActivationKey>;

/// Of the rate of strain unless the model is none, by exactly one of stiffness_proportional, stiffness_ratio
/// and (alpha, beta); and of velocity, by at most one of mass_proportional and mass_ratio. A ratio is of the
/// critical damping of a vibration of `frequency`.
struct DampingConfig {
  DampingModel model = DampingModel::rotated;  ///< none only beside damping of velocity, or in a group
  std::optional<double> stiffness_proportional;  ///< [s] ≥ 0: α = τλ, β = τμ with the λ, μ of the moment
  std::optional<double> stiffness_ratio;         ///< [-] ≥ 0
  double alpha = 0;                              ///< [Pa s] ≥ 0
  double beta = 0;                               ///< [Pa s] ≥ 0
  std::optional<double> mass_proportional;       ///< [1/s] ≥ 0
  std::optional<double> mass_ratio;              ///< [-] ≥ 0
  double frequency = 0;                          ///< [Hz] > 0 where a ratio is given
};

/// What the body is to become, by a map of its rest shape about the middle of its bounding box.
struct MeshGoal {
  std::string path;  ///< a mesh file of the same nodes and cells; relative to the scene file; resolved here
};
struct DeformationGoal {
  std::string path;  ///< a text file of nine numbers per cell; relative to the scene file; resolved here
};
struct FlattenGoal {
  double factor = 1;      ///< [-] > 0 along the axis; volume is kept
  Vec3d axis{{0, 1, 0}};  ///< unit vector
};
struct TwistGoal {
  double rate = 0;        ///< [rad/m] about the axis
  Vec3d axis{{0, 1, 0}};  ///< unit vector
};
struct BendGoal {
  double curvature = 0;      ///< [1/m] of the axis through the middle
  Vec3d axis{{1, 0, 0}};     ///< unit vector
  Vec3d towards{{0, 1, 0}};  ///< unit vector across the axis: where the centre of the circle lies
};
struct GoalConfig {
  std::variant<MeshGoal, DeformationGoal, FlattenGoal, TwistGoal, BendGoal> shape;
  double strength = 0;                                     ///< [1/s] ≥ 0
  double from = 0;                                         ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s] > from
};

/// Exactly one of the yields; of the hardenings at most one. Stresses are those of isochoric flow in tension.
struct PlasticityConfig {
  std::optional<double> yield_strain;       ///< [-] > 0
  std::optional<double> yield_stress;       ///< [Pa] > 0
  std::optional<double> hardening;          ///< [-] ≥ 0
  std::optional<double> hardening_modulus;  ///< [Pa] ≥ 0
  bool isochoric = true;                    ///< false with a goal
  double relaxation_time = 0;               ///< [s] ≥ 0
  double limit = 4;                         ///< [-] > 1
  std::optional<GoalConfig> goal;           ///< of a body, not of a group
};

/// What differs in one named volume group of the mesh; empty members: as in the body.
struct GroupConfig {
  std::string name;
  std::optional<double> density;  ///< [kg/m^3]
  std::optional<MaterialConfig> material;
  std::optional<DampingConfig> damping;
  std::optional<ActivationConfig> activation;
  std::optional<PlasticityConfig> plasticity;
};

struct BodyConfig {
  std::string name;
  MeshConfig mesh;
  int order = 1;  ///< of the shape functions: 1, or 2 for tetrahedra with middle nodes
  TransformConfig transform;
  double density = 0;  ///< [kg/m^3] > 0
  Vec3d velocity{};    ///< [m/s] initial
  Vec3d spin{};        ///< [rad/s] initial, about the centre of mass
  std::optional<StartConfig> start;
  MaterialConfig material;
  std::optional<DampingConfig> damping;
  std::optional<FibreConfig> fibres;           ///< there exactly when some material needs it
  std::optional<ActivationConfig> activation;  ///< of muscle; empty: not active
  std::optional<PlasticityConfig> plasticity;  ///< empty: the body is elastic
  bool mean_dilatation = false;                ///< of neo_hookean and rotated_linear
  Precision precision = Precision::full;
  std::vector<GroupConfig> groups;
};

// --- obstacles and constraints

/// How an obstacle moves from the place that its shape has at t = 0: steadily, by a table, or to and fro.
struct MotionConfig {
  std::optional<Vec3d> about;      ///< [m] the point that it turns about; empty: the middle of the shape
  Vec3d velocity{};                ///< [m/s] of that point
  Vec3d angular_velocity{};        ///< [rad/s]
  std::vector<PoseKey> keyframes;  ///< displacements; empty: none, or those of the file
  std::string file;                ///< with them; relative to the scene file; resolved here
  Vec3d amplitude{};               ///< [m] of an oscillation
  Vec3d angle{};                   ///< [rad] of an oscillation, along its axis
  double frequency = 0;            ///< [Hz] of an oscillation; 0: there is none
  double phase = 0;                ///< [rad]
};

struct ObstacleConfig {
  std::string name;
  ShapeConfig shape;    ///< at t = 0
  double friction = 0;  ///< [-] Coulomb coefficient ≥ 0
  Vec3d velocity{};     ///< [m/s] constant; not with motion
  std::optional<MotionConfig> motion;
  std::optional<double> until;  ///< [s] it is there until then; not with mass or density
  // Of a rigid body that moves by the forces on it, which has exactly one of mass and density:
  std::optional<double> mass;        ///< [kg] > 0
  std::optional<double> density;     ///< [kg/m^3] > 0
  Vec3d initial_velocity{};          ///< [m/s] of its centre of mass
  Vec3d initial_angular_velocity{};  ///< [rad/s]
};

/// Nodes whose position at rest, after the body's transform, lies inside (or on) the region.
struct BoxSelection {
  Vec3d min{};  ///< [m]
  Vec3d max{};  ///< [m]
};
struct SphereSelection {
  Vec3d center{};     ///< [m]
  double radius = 0;  ///< [m]
};
/// A set of nodes named by the mesh file or the generator (a box has x_min, x_max, ..., z_max).
struct NamedSelection {
  std::string node_set;
};
using NodeSelection = std::variant<NamedSelection, BoxSelection, SphereSelection>;

struct VelocityKey {
  double time = 0;   ///< [s]
  Vec3d velocity{};  ///< [m/s]
};

/// Nodes whose velocity is prescribed.
struct ConstraintConfig {
  std::string body_name;
  std::size_t body = 0;  ///< its index into SceneConfig::bodies
  NodeSelection nodes;
  bool fixed = false;  ///< then velocity is one key, 0 at 0 s
  /// Linear in between, constant outside; times strictly increasing; never empty.
  std::vector<VelocityKey> velocity;
  std::array<bool, 3> axes{true, true, true};              ///< components that are prescribed
  double from = 0;                                         ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
};

// --- events

enum class EventTarget { material, damping, gravity, friction };

/// A value that changes at a time. Listed in order of time (the scene's order among equals).
struct EventConfig {
  double at = 0;    ///< [s]
  std::string set;  ///< as written: bodies.torus.material.youngs_modulus
  EventTarget target = EventTarget::material;
  std::size_t owner = 0;             ///< index into bodies; into obstacles for friction; unused for gravity
  std::optional<std::size_t> group;  ///< index into BodyConfig::groups when the target lies in a group
  double value = 0;                  ///< unless gravity
  Vec3d vector{};                    ///< gravity
};

// --- the run

enum class OutputField { velocity, min_stretch, inversion, rank, plastic_strain, plastic_volume };

struct OutputConfig {
  std::string directory;                    ///< runs/<name> unless given; relative to the working directory
  std::optional<double> frames_per_second;  ///< [1/s]; empty: no frames are written
  std::vector<OutputField> fields;          ///< besides the positions
  std::optional<double> energy_log;         ///< [s] between rows, 0: every step; empty: no log
};

struct IntegratorConfig {
  IntegrationMethod method = IntegrationMethod::newmark;
  MassForm mass = MassForm::lumped;   ///< consistent only with newmark, without obstacles
  std::optional<double> time_step;    ///< [s]; empty: auto
  double safety = 0.9;                ///< [-] of the stable step, with auto
  double max_strain_increment = 0.1;  ///< [-] largest change of strain in one step, with auto
  QuasistaticOptions quasistatic;     ///< of that method
};

/// Elements too fast for the step are filtered.
struct FilterConfig {
  std::optional<double> time_step;  ///< [s] > 0; empty: auto
  FilterSelection selection = FilterSelection::spare_mass;
  double safety = 1.25;         ///< [-] ≥ 1
  double most_softened = 0.05;  ///< [-] in (0, 1], with auto
  FilterConstraints constraints = FilterConstraints::compliant;
  FilterProjection projection = FilterProjection::shake;  ///< of `paper`
  int projection_sweeps = 0;  ///< [-] of `paper`, most iterations a step; 0: until lengths are kept
};

struct CheckpointConfig {
  std::optional<double> every_simulated;  ///< [s]
  std::optional<double> every_wall;       ///< [s]
};

struct SceneConfig {
  int schema_version = 1;
  std::string name;
  double end_time = 0;  ///< [s]
  OutputConfig output;
  Vec3d gravity{};  ///< [m/s^2]
  std::vector<BodyConfig> bodies;
  std::vector<ObstacleConfig> obstacles;
  std::vector<ConstraintConfig> constraints;
  std::vector<EventConfig> events;
  IntegratorConfig integrator;
  std::optional<FilterConfig> filter;
  std::optional<CheckpointConfig> checkpoint;
  std::vector<std::pair<std::string, std::string>> petsc;  ///< option (no dash) and value, in order

  std::string file;  ///< the scene file it came from
  std::string text;  ///< the scene after overrides, in a canonical form
  /// The part of the text that a restart must share: all but the duration, output, checkpoints and solver.
  std::string identity;
};

}  // namespace evert
