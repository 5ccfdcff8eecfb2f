#pragma once
#include "evert/forces/consistent_mass.hpp"
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/mass_form.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

/// The elastic bodies of a rank: the one loop that owns gather, kernel and scatter, and overlaps the halo
/// with interior elements.
namespace evert {

/// What one entry of DistributedMesh::cells is made of.
struct ElasticProperties {
  double density = 0;  ///< [kg/m^3]
  Material material;
  Damping damping;
  Precision precision = Precision::full;
  /// A force −a m v on every node, a in [1/s]; empty: none, and none later either.
  std::optional<double> mass_proportional_damping{};
  std::optional<Plasticity> plasticity{};  ///< of isotropic models in double; empty: nothing flows
  bool mean_dilatation = false;            ///< see ElasticCells
};

/// Cells of one entry of DistributedMesh::cells whose forces are of another kind than those of its region.
struct SeparateCells {
  std::size_t entry = 0;
  std::vector<LocalIndex> cells{};        ///< their numbers in the entry, ascending
  std::unique_ptr<ElasticBlock> block{};  ///< of these cells in this order; null without cells
};

/// The flow of bodies at a time, of this rank.
struct PlasticState {
  double work = 0;                  ///< that has gone into flow [J], ≥ 0
  double control_work = 0;          ///< of controls on the elastic energy [J]
  double goal_square = 0;           ///< ∫‖log S‖² dV of the goals, S the stretch of F_p [m³]
  double goal_distance_square = 0;  ///< ∫‖log S − that of the goal‖² dV
};

class ElasticForces {
 public:
  /// Collective. One ElasticBlock per entry of `mesh.cells`, with `properties` of its region; a UserError of
  /// any rank (cells without volume) is thrown on all.
  ElasticForces(const DistributedMesh& mesh, std::span<const ElasticProperties> properties,
                MassForm mass = MassForm::lumped);

  /// Collective. Brings the ghosts of `x` up to date, then `f` = elastic forces at x [N], summed over ranks
  /// on owned nodes; C(x) is kept for apply_damping.  PHYSICS 5: F and its SVD once per step, here
  void update(NodeField& x, NodeField& f);
  /// Not collective. The times of the last update and of the next one [s], which may let points flow.
  void set_times(double last, double next);

  /// Collective. `out` += factor · C v on owned nodes; updates the ghosts of `v`. The ghosts of `out` are
  /// scratch.
  void add_damping(NodeField& v, NodeField& out, double factor) const;

  /// Collective. Of consistent masses: `out` += M v on owned nodes; ghosts as in add_damping.
  void add_momentum(NodeField& v, NodeField& out) const;
  /// Collective. Of consistent masses: `out` += M v + factor · C v, with one exchange of ghosts for both.
  void add_momentum_and_damping(NodeField& v, NodeField& out, double factor) const;

  /// Collective. The symmetric 3×3 diagonal blocks of C at owned nodes: xx yy zz in `normal`, yz xz xy in
  /// `shear`. Their ghosts are scratch.
  void damping_diagonal(NodeField& normal, NodeField& shear) const;

  /// The part of C that is proportional to mass, per owned node [kg/s]; empty when no body has any. Of
  /// consistent masses the sums of its rows: what it has of the resultant.
  [[nodiscard]] std::span<const double> mass_damping() const { return mass_damping_; }

  /// True when anything of any rank is damped.
  [[nodiscard]] bool damped() const { return damped_; }
  /// True where the velocities of nodes depend on the momenta of others: to find them takes a solve.
  [[nodiscard]] bool couples_velocities() const { return damped_ || consistent_mass_ != nullptr; }

  // Sums over this rank's cells, at positions whose ghosts are up to date:
  [[nodiscard]] double energy(const NodeField& x) const;
  [[nodiscard]] LocalIndex inverted_points(const NodeField& x) const;
  [[nodiscard]] StableStep stable_step(const NodeField& x) const;
  [[nodiscard]] double max_strain_rate(const NodeField& x, const NodeField& v) const;
  /// Smallest signed stretch per cell of an entry of DistributedMesh::cells.
  void min_stretch(const NodeField& x, std::size_t entry, std::span<double> per_cell) const;

  /// True where points of any rank can flow.
  [[nodiscard]] bool may_flow() const;
  [[nodiscard]] PlasticState plastic_state() const;
  /// Per cell of an entry of DistributedMesh::cells, nothing where its region cannot flow: plastic strain as
  /// in tension, and det F_p.
  void equivalent_plastic_strain(std::size_t entry, std::span<double> per_cell) const;
  void plastic_volume_ratio(std::size_t entry, std::span<double> per_cell) const;
  /// Numbers that each cell of an entry remembers of its flow, 0 where it cannot flow; and all of them, cell
  /// after cell.
  [[nodiscard]] std::size_t flow_numbers(std::size_t entry) const;
  [[nodiscard]] std::vector<double> flow(std::size_t entry) const;
  /// The rows of cells may be longer.
  void set_flow(std::size_t entry, std::span<const double> numbers);
  /// Not collective. Controls the flow of a region: `position(entry, cell, node of the cell)` as in
  /// PlasticCells::set_goal. Returns the global numbers of this rank's cells whose goal is not allowed.
  using GoalPosition = std::function<Vec3d(std::size_t entry, LocalIndex cell, std::size_t node)>;
  [[nodiscard]] std::vector<GlobalIndex> set_goal(std::int32_t region, const PlasticControl& control,
                                                  const GoalPosition& position);

  /// How far log F_p of the cells of an entry has gone at most since the beginning of its way; nothing where
  /// its region cannot flow.
  void way_of_flow(std::size_t entry, std::span<double> per_cell) const;
  /// From now on they are so long, and may become so long.
  void set_way_of_flow(std::size_t entry, std::span<const double> per_cell);
  void bound_way_of_flow(std::size_t entry, std::span<const double> per_cell);
  /// True where a cell of this rank has gone farther. Does not allocate.
  [[nodiscard]] bool flow_is_beyond_bounds() const;
  /// ∂N_a/∂X of an entry of tetrahedra, four a cell, in the shape that has flown and for every cell but for a
  /// rotation; those of regions that cannot flow are left as they are.
  void flown_gradients(std::size_t entry, std::span<Vec3d> gradients) const;

  /// Lumped masses of the owned nodes [kg], whatever M is.
  [[nodiscard]] std::span<const double> masses() const { return masses_; }
  /// M 1 per owned node [kg]: what a node has of the weight, and its velocity of the momentum. The lumped
  /// masses themselves, unless M is consistent.
  [[nodiscard]] std::span<const double> mass_row_sums() const {
    return consistent_mass_ != nullptr ? consistent_mass_->row_sums() : std::span<const double>(masses_);
  }
  /// M and the part of C that is proportional to it, of consistent masses; else nullptr.
  [[nodiscard]] const ConsistentMass* consistent_mass() const { return consistent_mass_.get(); }
  [[nodiscard]] const ConsistentMass* consistent_mass_damping() const {
    return consistent_mass_damping_.get();
  }
  /// First one per entry of DistributedMesh::cells, null where a rank has no cells of it or all are separate;
  /// then those of separate cells.
  [[nodiscard]] std::span<const std::unique_ptr<ElasticBlock>> blocks() const { return blocks_; }
  /// The entry of DistributedMesh::cells that block number `block` has cells of.
  [[nodiscard]] std::size_t entry_of(std::size_t block) const;
  /// Which cells of that entry they are, in the order of the block.
  [[nodiscard]] std::vector<LocalIndex> cells_in(std::size_t block) const;
  /// Of a region, at rest [kg/m^3].
  [[nodiscard]] double density(std::int32_t region) const { return properties(region).density; }
  [[nodiscard]] const Halo& halo() const { return halo_; }
  /// Of a region at present.
  [[nodiscard]] const ElasticProperties& properties(std::int32_t region) const {
    return properties_[static_cast<std::size_t>(region)];
  }
  /// Collective. Changes the material of every block of `region`; call update() afterwards.
  void set_properties(std::int32_t region, const ElasticProperties& properties);
  /// Not collective. Sets the activation of the muscle of `region`, in [0, 1]; call update() afterwards. Does
  /// not allocate.
  void set_activation(std::int32_t region, double activation);
  /// Collective. Takes cells out of the block of their entry and gives them to one of their own, and earlier
  /// ones of the listed entries back; entries that no rank lists stay as they are. Masses stay those of all
  /// cells. Masses must be lumped. What has flown, and goals, stay with the cells. Call update() afterwards.
  void separate(std::vector<SeparateCells> separate_cells);
  /// Bytes of element data on this rank, and of what of them flow has.
  [[nodiscard]] std::size_t memory() const;
  [[nodiscard]] std::size_t plastic_memory() const;

 private:
  struct Goal {
    std::int32_t region;
    PlasticControl control;
    GoalPosition position;
  };

  [[nodiscard]] bool is_of_region(std::size_t block, std::int32_t region) const;
  /// Of a block in which nothing has flown. Returns the global numbers of the cells where it is not allowed.
  std::vector<GlobalIndex> apply(const Goal& goal, std::size_t block);
  /// Calls `work(plastic cells, number in the block, cell of the entry)` for all cells of an entry that can
  /// flow.
  template <class Work>
  void for_each_flowing(std::size_t entry, Work&& work) const;
  /// Of the cells of an entry that are in `cells`, ascending.
  [[nodiscard]] std::unique_ptr<ElasticBlock> make_block(std::size_t entry,
                                                         std::span<const LocalIndex> cells) const;
  [[nodiscard]] std::vector<double> densities() const;  // per region
  /// Collective. What the cells contribute to the owned nodes, each with the density of its region.
  [[nodiscard]] std::vector<double> lumped(std::span<const double> densities);
  /// add_damping with what else is to be done while ghosts are at hand.
  template <class AtBoundary>
  void damp(NodeField& v, NodeField& out, double factor, AtBoundary&& at_boundary) const;
  /// Collective. With consistent masses: what the stable step of lumped ones is to be multiplied by.
  void bound_consistent_step();
  /// Collective. The part of C that is proportional to mass, of damped_densities_.
  void make_mass_damping();

  const DistributedMesh& mesh_;
  Halo halo_;
  std::vector<ElasticProperties> properties_;          // per region
  std::vector<std::unique_ptr<ElasticBlock>> blocks_;  // see blocks()
  std::vector<Goal> goals_;
  struct Separation {
    std::size_t entry;
    std::vector<LocalIndex> cells;
  };
  std::vector<Separation> separations_;  // of the blocks behind those of the entries
  std::vector<double> masses_;
  std::vector<double> damped_densities_;  // ρ a per region [kg/(m^3 s)]; empty when none has an a
  std::vector<double> mass_damping_;
  std::unique_ptr<ConsistentMass> consistent_mass_, consistent_mass_damping_;  // where asked for
  double lumped_over_consistent_ = 1;  // masses, the largest ratio in any cell
  double step_over_lumped_ = 1;        // of the stable step
  mutable NodeField scratch_;          // columns of the diagonal blocks on their way to the owners
  bool damped_ = false;
};

}  // namespace evert
