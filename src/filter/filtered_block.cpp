#include "evert/filter/filtered_block.hpp"

#include "evert/core/error.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/elements/reference_element.hpp"
#include "evert/forces/kernels/measure_kernels.hpp"

#include "filtered_cell.hpp"
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace evert {
namespace {

/// The model of an isotropic `material`.
template <class Visit>
auto visit_isotropic(const Material& material, Visit&& visit) {
  using Result = decltype(visit(RotatedLinear{}));
  return std::visit(
      [&]<class Model>(const Model& model) -> Result {
        if constexpr (HasFibres<Model>) {
          EVERT_ASSERT(false, std::string(Model::name));
        } else {
          return visit(model);
        }
      },
      material);
}

Lame lame_of(const Material& material) {
  return std::visit([](const auto& model) { return model.lame; }, material);
}

/// A block whose batches are single cells.
class FilteredBlock final : public ElasticBlock {
 public:
  FilteredBlock(const ElasticCells& cells, std::span<const Vec3d> rest_positions, const Material& material,
                const Damping& damping, std::span<const CellClamp> clamps);

  [[nodiscard]] BatchRange interior() const override { return {0, interior_}; }
  [[nodiscard]] BatchRange boundary() const override { return {interior_, cells()}; }
  void update(const double* x, double* f, BatchRange batches) override;
  [[nodiscard]] CellType type() const override { return CellType::tet4; }
  [[nodiscard]] const Material& material() const override { return material_; }
  [[nodiscard]] const Damping& damping() const override { return damping_; }
  [[nodiscard]] bool damped() const override { return damping_.model != DampingModel::none; }
  void add_damping(const double* v, double* out, double factor, BatchRange batches) const override;
  void add_damping_diagonal(double* normal, double* shear, double factor) const override;
  void damping_matrix(LocalIndex cell, std::span<double> matrix) const override;
  void stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const override;
  [[nodiscard]] CellNodes cell_nodes(LocalIndex cell) const override;
  [[nodiscard]] LocalIndex cells() const override { return static_cast<LocalIndex>(cells_.size()); }
  [[nodiscard]] double energy(const double* x) const override;
  void min_stretch(const double* x, std::span<double> per_cell) const override;
  [[nodiscard]] LocalIndex inverted_points(const double* x) const override;
  [[nodiscard]] StableStep stable_step(const double* x) const override;
  [[nodiscard]] double max_strain_rate(const double* x, const double* v) const override;
  [[nodiscard]] double rest_stiffness_of(LocalIndex cell) const override {
    return largest_[static_cast<std::size_t>(cell)];
  }
  void set_mass_shares(std::span<const double> shares) override;
  void set_material(const Material& material, const Damping& damping) override;
  void set_activation(double /*activation*/) override {}  // isotropic models have none
  [[nodiscard]] std::size_t memory() const override;

 private:
  void set_filters();
  [[nodiscard]] TetShape shape_of(std::size_t cell) const;
  template <class Model>
  [[nodiscard]] double stiffness_now(const Model& model, std::size_t cell, const Svd3d& f) const;

  std::vector<FilteredCell> cells_;
  std::vector<CellClamp> clamps_;
  std::vector<TetMasses> shares_;      // of set_mass_shares
  std::vector<double> largest_;        // λ_e against them [1/s²]
  std::vector<Mat3d> damping_frames_;  // of the last update; empty without damping
  LocalIndex interior_;
  Material material_;
  Damping damping_;
  double density_;
};

Svd3d deformation(const FilteredCell& cell, const double* x) {
  return svd3(gradient_of(cell, values_of(cell, x)));
}

/// σ3, or 0 where that is zero to the rounding of σ1 and its sign without meaning.
double smallest_stretch(const Svd3d& f) {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  return std::abs(f.sigma[2]) < rounding * f.sigma[0] ? 0 : f.sigma[2];
}

void add_to_node(double* field, LocalIndex node, const Vec3d& value) {
  double* at = field + 3 * static_cast<std::ptrdiff_t>(node);
  for (std::size_t k = 0; k < 3; ++k) at[k] += value[k];
}

/// Dense row-major 12×12 of a linear map from dF to |∂X/∂ξ| W dP.
template <class Map>
void fill_matrix(const FilteredCell& cell, Map&& map, std::span<double> matrix) {
  for (std::size_t b = 0; b < 4; ++b) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3d unit{};
      unit[k] = 1;
      const Mat3d stress = map(outer(unit, cell.gradients[b]));
      for (std::size_t a = 0; a < 4; ++a) {
        const Vec3d force = stress * cell.gradients[a];
        for (std::size_t i = 0; i < 3; ++i) matrix[(3 * a + i) * 12 + 3 * b + k] = force[i];
      }
    }
  }
}

FilteredBlock::FilteredBlock(const ElasticCells& cells, std::span<const Vec3d> rest_positions,
                             const Material& material, const Damping& damping,
                             std::span<const CellClamp> clamps)
    : cells_(cells.nodes.size() / 4),
      clamps_(clamps.begin(), clamps.end()),
      shares_(cells_.size()),
      largest_(cells_.size()),
      interior_(cells.interior),
      material_(material),
      damping_(damping),
      density_(cells.density) {
  EVERT_ASSERT(cells.type == CellType::tet4 && clamps.size() == cells_.size(), std::to_string(clamps.size()));
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const auto nodes = cells.nodes.subspan(4 * c, 4);
    const TetShape shape = tet_shape(nodes, rest_positions);
    std::copy(nodes.begin(), nodes.end(), cells_[c].nodes.begin());
    cells_[c].gradients = shape.gradients;
    cells_[c].volume = shape.volume;
    cells_[c].filter.axes = identity<double>();
    shares_[c].fill(density_ * shape.volume / 4);
  }
  if (damped()) damping_frames_.assign(cells_.size(), identity<double>());
  set_filters();
}

/// As cell number `cell` is turned.
TetShape FilteredBlock::shape_of(std::size_t cell) const {
  return {cells_[cell].gradients, cells_[cell].volume};
}

/// The filters of the present material, each cell turned along its axes: they are the axes of its strains,
/// and what is kept of them is that they are none any more.
void FilteredBlock::set_filters() {
  const Lame lame = lame_of(material_);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    auto& cell = cells_[c];
    const StrainFilter filter =
        strain_filter(element_modes(shape_of(c), clamps_[c].masses, lame), lame, clamps_[c].limit);
    for (Vec3d& g : cell.gradients) g = transpose_times(filter.axes, g);
    cell.filter = {identity<double>(), filter.stretch, filter.shear};
    largest_[c] = largest_eigenvalue(shape_of(c), shares_[c], lame, cell.filter);
  }
}

void FilteredBlock::update(const double* x, double* f, BatchRange batches) {
  visit_isotropic(material_, [&](const auto& model) {
    for (LocalIndex c = batches.begin; c < batches.end; ++c) {
      const FilteredCell& cell = cells_[static_cast<std::size_t>(c)];
      const TetValues at_nodes = values_of(cell, x);
      const Mat3d gradient = gradient_of(cell, at_nodes);
      const Svd3d svd = svd3(gradient);
      const Mat3d stress = cell.filter.transposed(stress_of(model, filtered_strain(cell, svd)));
      const TetValues forces = balanced_forces(cell, at_nodes, rotation_of(svd) * stress);
      for (std::size_t a = 0; a < 4; ++a) add_to_node(f, cell.nodes[a], forces[a]);
      if (damped())
        damping_frames_[static_cast<std::size_t>(c)] = damping_frame(damping_.model, gradient, svd);
    }
  });
}

void FilteredBlock::add_damping(const double* v, double* out, double factor, BatchRange batches) const {
  if (!damped()) return;
  for (LocalIndex c = batches.begin; c < batches.end; ++c) {
    const FilteredCell& cell = cells_[static_cast<std::size_t>(c)];
    const Mat3d stress = factor * viscous_stress(cell, damping_, damping_frames_[static_cast<std::size_t>(c)],
                                                 gradient_of(cell, values_of(cell, v)));
    Vec3d balance{};
    for (std::size_t a = 1; a < 4; ++a) {
      const Vec3d force = stress * cell.gradients[a];
      add_to_node(out, cell.nodes[a], force);
      balance -= force;
    }
    add_to_node(out, cell.nodes[0], balance);
  }
}

void FilteredBlock::add_damping_diagonal(double* normal, double* shear, double factor) const {
  if (!damped()) return;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const FilteredCell& cell = cells_[c];
    for (std::size_t a = 0; a < 4; ++a) {
      Mat3d block;
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3d unit{};
        unit[k] = factor;
        block.column[k] = viscous_stress(cell, damping_, damping_frames_[c], outer(unit, cell.gradients[a])) *
                          cell.gradients[a];
      }
      add_to_node(normal, cell.nodes[a], {block(0, 0), block(1, 1), block(2, 2)});
      add_to_node(shear, cell.nodes[a], {block(2, 1), block(2, 0), block(1, 0)});
    }
  }
}

void FilteredBlock::damping_matrix(LocalIndex cell, std::span<double> matrix) const {
  std::fill(matrix.begin(), matrix.end(), 0.0);
  if (!damped()) return;
  const auto c = static_cast<std::size_t>(cell);
  fill_matrix(
      cells_[c],
      [&](const Mat3d& rate) { return viscous_stress(cells_[c], damping_, damping_frames_[c], rate); },
      matrix);
}

void FilteredBlock::stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const {
  std::array<double, 144> matrix;
  visit_isotropic(material_, [&](const auto& model) {
    for (LocalIndex c = 0; c < cells(); ++c) {
      const FilteredCell& cell = cells_[static_cast<std::size_t>(c)];
      const FilteredTangent tangent(model, cell, deformation(cell, x), form == TangentForm::projected);
      fill_matrix(
          cell, [&](const Mat3d& change) { return cell.volume * tangent(change); }, matrix);
      take(c, matrix);
    }
  });
}

CellNodes FilteredBlock::cell_nodes(LocalIndex cell) const {
  CellNodes nodes(4);
  for (std::size_t a = 0; a < 4; ++a) nodes[a] = cells_[static_cast<std::size_t>(cell)].nodes[a];
  return nodes;
}

double FilteredBlock::energy(const double* x) const {
  return visit_isotropic(material_, [&](const auto& model) {
    double sum = 0;
    for (const FilteredCell& cell : cells_)
      sum += cell.volume * energy_of(model, filtered_strain(cell, deformation(cell, x)));
    return sum;
  });
}

void FilteredBlock::min_stretch(const double* x, std::span<double> per_cell) const {
  for (std::size_t c = 0; c < cells_.size(); ++c) per_cell[c] = smallest_stretch(deformation(cells_[c], x));
}

LocalIndex FilteredBlock::inverted_points(const double* x) const {
  return static_cast<LocalIndex>(std::count_if(cells_.begin(), cells_.end(), [x](const FilteredCell& cell) {
    return smallest_stretch(deformation(cell, x)) < 0;
  }));
}

/// Of its eigenvalues against the shares [1/s²], at most about: how much stiffer the model is at S̃ than at
/// rest, and what stress adds when the element turns. P = R σ' turns with R, whose change per unit of
/// displacement is at most |g|/(σ_i + σ_j), and taking the torque off at most doubles that.
template <class Model>
double FilteredBlock::stiffness_now(const Model& model, std::size_t c, const Svd3d& f) const {
  const FilteredCell& cell = cells_[c];
  const Mat3d strain = filtered_strain(cell, f);
  const auto [values, axes] = principal_axes(strain);
  const double stretching = kernels::tangent_bound(model, values, 1).stretching;
  const Mat3d stress = cell.filter.transposed(stress_of(model, strain));
  double turned = 0, turning = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3d pull = stress * cell.gradients[a];
    turned += dot(pull, pull) / shares_[c][a];
    turning += dot(cell.gradients[a], cell.gradients[a]) / shares_[c][a];
  }
  const double sum = std::max(f.sigma[1] + f.sigma[2], kernels::smallest_stretch_sum);
  return std::max(stretching, 1.0) * largest_[c] + 2 * cell.volume * std::sqrt(turned * turning) / sum;
}

StableStep FilteredBlock::stable_step(const double* x) const {
  const double stiffness = visit_isotropic(material_, [&](const auto& model) {
    double largest = 0;
    if (!(model.lame.mu > 0)) return largest;  // E = 0: nothing limits the step
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const double of_cell = stiffness_now(model, c, deformation(cells_[c], x));
      largest = std::max(largest,
                         of_cell < kernels::unresolvable<double> ? of_cell : kernels::unresolvable<double>);
    }
    return largest;
  });
  // Damping would raise the limit; what is filtered gets no credit for it.
  const double limit = 2 / std::sqrt(stiffness);
  return {limit, limit};
}

double FilteredBlock::max_strain_rate(const double* x, const double* v) const {
  double fastest_squared = 0;
  for (const FilteredCell& cell : cells_) {
    const Mat3d rate = gradient_of(cell, values_of(cell, v));
    if (contract(rate, rate) <= fastest_squared) continue;
    fastest_squared =
        std::max(fastest_squared, kernels::relative_strain_rate_squared(deformation(cell, x), rate));
  }
  return std::sqrt(fastest_squared);
}

void FilteredBlock::set_mass_shares(std::span<const double> shares) {
  const Lame lame = lame_of(material_);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    std::copy_n(shares.begin() + static_cast<std::ptrdiff_t>(4 * c), 4, shares_[c].begin());
    largest_[c] = largest_eigenvalue(shape_of(c), shares_[c], lame, cells_[c].filter);
  }
}

void FilteredBlock::set_material(const Material& material, const Damping& damping) {
  EVERT_ASSERT(material.index() == material_.index() && damping.model == damping_.model,
               std::to_string(material.index()) + " for " + std::to_string(material_.index()));
  material_ = material;
  damping_ = damping;
  for (std::size_t c = 0; c < cells_.size(); ++c) shares_[c].fill(density_ * cells_[c].volume / 4);
  set_filters();
}

std::size_t FilteredBlock::memory() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  return bytes(cells_) + bytes(clamps_) + bytes(shares_) + bytes(largest_) + bytes(damping_frames_);
}

}  // namespace

std::unique_ptr<ElasticBlock> make_filtered_block(const ElasticCells& cells,
                                                  std::span<const Vec3d> rest_positions,
                                                  const Material& material, const Damping& damping,
                                                  std::span<const CellClamp> clamps) {
  return std::make_unique<FilteredBlock>(cells, rest_positions, material, damping, clamps);
}

}  // namespace evert
