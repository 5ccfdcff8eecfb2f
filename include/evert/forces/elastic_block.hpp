#pragma once
#include "evert/elements/element_block.hpp"
#include "evert/materials/damping.hpp"
#include "evert/materials/material.hpp"
#include "evert/materials/plasticity.hpp"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <variant>

/// Elastic and damping forces of one block of elements. Knows neither MPI nor PETSc: plain arrays of local
/// nodal values, x y z per node, one double of slack behind the last node.
namespace evert {

class PlasticCells;

/// What bounds the stable time step of a block. With M*_e a cell's shares of the masses of its nodes, λ is
/// the largest eigenvalue of K_e against M*_e (PHYSICS 9); a step is stable when 1 + Δt/2·(damping) − Δt²/4·λ
/// ≥ 0 for every element.
struct StableStep {
  double undamped = 0;  ///< [s] largest step with explicit elastic forces and no damping
  double damped = 0;    ///< [s] the same with this block's damping taken implicitly; ≥ undamped
};

/// The nodes of one cell, by value: batches do not keep them together.
class CellNodes {
 public:
  explicit CellNodes(std::size_t count) : count_(count) {}
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] LocalIndex& operator[](std::size_t a) { return nodes_[a]; }
  [[nodiscard]] LocalIndex operator[](std::size_t a) const { return nodes_[a]; }
  [[nodiscard]] auto begin() const { return nodes_.begin(); }
  [[nodiscard]] auto end() const { return nodes_.begin() + static_cast<std::ptrdiff_t>(count_); }

 private:
  std::array<LocalIndex, most_nodes> nodes_{};
  std::size_t count_;
};

/// What ∂P/∂F a stiffness matrix is made of.
enum class TangentForm {
  full,       ///< as it is
  projected,  ///< a positive semidefinite one not below it at every point, of isotropic models the
              ///< nearest: a Newton step on it descends
};

/// Takes the dense matrix of one cell, row-major 3n×3n, which lasts for the call. `cell` counts as in
/// ElementBlock::cell_of_lane.
using TakeCellMatrix = std::function<void(LocalIndex cell, std::span<const double> matrix)>;

/// Forces of one (element type × material × damping) block; made by make_elastic_block for the CPU it runs
/// on. None of its calls is collective. No call allocates except the constructor and set_material.
class ElasticBlock {
 public:
  virtual ~ElasticBlock() = default;

  /// The batches, to be computed in two parts around the halo exchange.
  [[nodiscard]] virtual BatchRange interior() const = 0;
  [[nodiscard]] virtual BatchRange boundary() const = 0;

  /// Evaluates F and its diagonalisation at `x` once: adds the elastic forces −∂ψ/∂x [N] to `f`, keeps what
  /// C(x) needs (9 numbers a point for `rotated`; nothing without damping).  paper A, sections 3-6
  virtual void update(const double* x, double* f, BatchRange batches) = 0;

  /// What the block was made of, with the parameters of the moment.
  [[nodiscard]] virtual CellType type() const = 0;
  [[nodiscard]] virtual const Material& material() const = 0;
  [[nodiscard]] virtual const Damping& damping() const = 0;
  [[nodiscard]] virtual bool damped() const = 0;
  /// out += factor · C v with C from the last update (symmetric positive semidefinite).  paper A, section 6.2
  virtual void add_damping(const double* v, double* out, double factor, BatchRange batches) const = 0;
  /// Adds factor · the symmetric 3×3 diagonal blocks of C per local node: xx yy zz to `normal`, yz xz xy to
  /// `shear`.
  virtual void add_damping_diagonal(double* normal, double* shear, double factor) const = 0;
  /// One cell's damping matrix, dense row-major 3n×3n, for assembly. `cell` counts as in
  /// ElementBlock::cell_of_lane.
  virtual void damping_matrix(LocalIndex cell, std::span<double> matrix) const = 0;
  /// The stiffness matrix −∂f/∂x [N/m] of every cell at `x`, symmetric, given to `take` one by one. Allocates
  /// nothing.
  virtual void stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const = 0;
  /// Local node numbers of a cell.
  [[nodiscard]] virtual CellNodes cell_nodes(LocalIndex cell) const = 0;
  [[nodiscard]] virtual LocalIndex cells() const = 0;

  /// Elastic energy at `x` [J].
  [[nodiscard]] virtual double energy(const double* x) const = 0;
  /// Per cell: the smallest signed principal stretch over its points; negative exactly when inverted (det F <
  /// 0).
  virtual void min_stretch(const double* x, std::span<double> per_cell) const = 0;
  /// Quadrature points with det F < 0 at `x`.
  [[nodiscard]] virtual LocalIndex inverted_points(const double* x) const = 0;
  /// Bound from the tangent at `x` (compressed nonlinear material is stiffer than at rest).  PHYSICS 5 and 9
  [[nodiscard]] virtual StableStep stable_step(const double* x) const = 0;
  /// Largest rate of strain [1/s] at v and x, the positions of the last update, to limit the change of strain
  /// in a step; relative to the stretch where that exceeds 1.
  [[nodiscard]] virtual double max_strain_rate(const double* x, const double* v) const = 0;

  /// λ_e [1/s²] of a cell: the largest eigenvalue of its stiffness at rest against its shares of mass; as it
  /// was made, whatever has flown since, so that the shares do not depend on when they are made.
  [[nodiscard]] virtual double rest_stiffness_of(LocalIndex cell) const = 0;
  /// The shares of the masses of its nodes [kg] that each cell is credited with in stable_step, node_count
  /// per cell; its own masses unless told otherwise. They must sum to the mass of every node, over all
  /// blocks.
  virtual void set_mass_shares(std::span<const double> shares) = 0;

  /// Replaces the parameters (timed events); same model and extension as before. Call update afterwards; the
  /// mass shares are the cells' own again.
  virtual void set_material(const Material& material, const Damping& damping) = 0;
  /// Sets the activation of muscle, in [0, 1]; of other models nothing changes. Call update afterwards. Does
  /// not allocate.
  virtual void set_activation(double activation) = 0;
  /// What its points remember of their flow; null where nothing flows. An update lets them flow.
  [[nodiscard]] virtual PlasticCells* plastic() { return nullptr; }
  [[nodiscard]] const PlasticCells* plastic() const { return const_cast<ElasticBlock*>(this)->plastic(); }
  /// Bytes of element data held.
  [[nodiscard]] virtual std::size_t memory() const = 0;
};

/// The cells of one block before batching.
struct ElasticCells {
  CellType type = CellType::tet4;
  std::span<const LocalIndex> nodes;  ///< node_count(type) per cell; interior cells first
  LocalIndex interior = 0;            ///< cells [0, interior) touch owned nodes only
  double density = 0;                 ///< [kg/m^3]
  std::span<const Vec3d>
      fibres{};                  ///< per cell, for models with fibres: their direction at rest, of length 1
  bool mean_dilatation = false;  ///< of models with a dilatation, in cells of several points (dilatation.hpp)
  std::optional<Plasticity> plasticity{};  ///< of isotropic models in double; empty: nothing flows
};

/// In mixed precision positions and forces stay double; rest data, damping state and all arithmetic between
/// are float, so that forces carry an error of about 1e-7 of the elastic moduli whatever the strain
/// (docs/performance.md).
///
/// Makes the block for the best instruction set of this CPU (x86-64-v2, v3, v4). `rest_positions` per local
/// node. Throws UserError when a cell has zero or negative rest volume.
[[nodiscard]] std::unique_ptr<ElasticBlock> make_elastic_block(const ElasticCells& cells,
                                                               std::span<const Vec3d> rest_positions,
                                                               const Material& material,
                                                               const Damping& damping,
                                                               Precision precision = Precision::full);

/// Adds each cell's mass, shared over its nodes, to `mass` (per local node, [kg]); stays positive.
void add_lumped_mass(const ElementView& element, const ElasticCells& cells,
                     std::span<const Vec3d> rest_positions, std::span<double> mass);
/// The same for the reference element of the cells' type.
void add_lumped_mass(const ElasticCells& cells, std::span<const Vec3d> rest_positions,
                     std::span<double> mass);

}  // namespace evert
