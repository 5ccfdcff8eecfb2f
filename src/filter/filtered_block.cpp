#include "evert/filter/filtered_block.hpp"

#include "evert/core/aligned.hpp"
#include "evert/core/error.hpp"
#include "evert/elements/batching.hpp"

#include "filtered_cell.hpp"
#include "filtered_forces.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace evert {
namespace {

using filtered::Cell;
namespace number = filtered::number;
namespace bound = filtered::bound;

/// The model of an isotropic `material`.
template <class Visit>
void visit_isotropic(const Material& material, Visit&& visit) {
  std::visit(
      [&]<class Model>(const Model& model) {
        if constexpr (HasFibres<Model>) {
          EVERT_ASSERT(false, std::string(Model::name));
        } else {
          visit(model);
        }
      },
      material);
}

Lame lame_of(const Material& material) {
  return std::visit([](const auto& model) { return model.lame; }, material);
}

/// The memory of a block; what is done once a step is handed on to kernels. Neither copied nor moved: the
/// kernels hold pointers into it.
class FilteredBlock final : public ElasticBlock {
 public:
  FilteredBlock(const ElasticCells& cells, std::span<const Vec3d> rest_positions, const Material& material,
                const Damping& damping, std::span<const CellClamp> clamps);
  FilteredBlock(const FilteredBlock&) = delete;
  FilteredBlock& operator=(const FilteredBlock&) = delete;

  [[nodiscard]] BatchRange interior() const override { return interior_; }
  [[nodiscard]] BatchRange boundary() const override { return {interior_.end, all().end}; }
  void update(const double* x, double* f, BatchRange batches) override {
    kernels_.update(arrays_, material_, damping_.model, x, f, batches);
  }
  [[nodiscard]] CellType type() const override { return CellType::tet4; }
  [[nodiscard]] const Material& material() const override { return material_; }
  [[nodiscard]] const Damping& damping() const override { return damping_; }
  [[nodiscard]] bool damped() const override { return damping_.model != DampingModel::none; }
  void add_damping(const double* v, double* out, double factor, BatchRange batches) const override {
    if (damped()) kernels_.add_damping(arrays_, damping_, factor, v, out, batches);
  }
  void add_damping_diagonal(double* normal, double* shear, double factor) const override {
    if (damped()) kernels_.add_damping_diagonal(arrays_, damping_, factor, normal, shear, all());
  }
  void damping_matrix(LocalIndex cell, std::span<double> matrix) const override;
  void stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const override;
  [[nodiscard]] CellNodes cell_nodes(LocalIndex cell) const override;
  [[nodiscard]] LocalIndex cells() const override { return static_cast<LocalIndex>(clamps_.size()); }
  [[nodiscard]] double energy(const double* x) const override {
    return kernels_.energy(arrays_, material_, x, all());
  }
  void min_stretch(const double* x, std::span<double> per_cell) const override {
    kernels_.min_stretch(arrays_, x, per_cell.data(), all());
  }
  [[nodiscard]] LocalIndex inverted_points(const double* x) const override {
    return kernels_.inverted_cells(arrays_, x, all());
  }
  [[nodiscard]] StableStep stable_step(const double* x) const override;
  [[nodiscard]] double max_strain_rate(const double* x, const double* v) const override {
    return kernels_.max_strain_rate(arrays_, x, v, all());
  }
  [[nodiscard]] double rest_stiffness_of(LocalIndex cell) const override {
    return bounds_[place(cell, bound::total, bound::largest)];
  }
  void set_mass_shares(std::span<const double> shares) override;
  void set_material(const Material& material, const Damping& damping) override;
  void set_activation(double /*activation*/) override {}  // isotropic models have none
  [[nodiscard]] std::size_t memory() const override;

 private:
  [[nodiscard]] BatchRange all() const {
    return {0, static_cast<LocalIndex>(cell_of_lane_.size()) / lanes()};
  }
  [[nodiscard]] LocalIndex lanes() const { return kernels_.lanes; }
  /// Of a number of a cell in an array of `numbers` a cell.
  [[nodiscard]] std::size_t place(LocalIndex cell, std::size_t numbers, std::size_t k) const;
  [[nodiscard]] Vec3d read_vector(LocalIndex cell, std::size_t first) const;
  void write_vector(LocalIndex cell, std::size_t first, const Vec3d& vector);
  void fill_lanes(const ElasticCells& cells, std::span<const Vec3d> rest_positions);
  void use_own_masses();
  void set_filters();
  [[nodiscard]] Cell at(LocalIndex cell) const;

  Material material_;
  Damping damping_;
  double density_;
  filtered::Kernels kernels_;
  std::vector<CellClamp> clamps_;
  std::vector<LocalIndex> cell_of_lane_, lane_of_cell_;
  BatchRange interior_;
  AlignedVector<LocalIndex> nodes_;
  AlignedVector<double> cells_, bounds_, damping_frames_;
  filtered::BlockArrays arrays_{};  // into the vectors above
};

/// Cells by lanes, in whole batches of cells without a node in common where that can be had; −1: padding.
std::vector<LocalIndex> lanes_of(LocalIndex begin, LocalIndex end, std::span<const LocalIndex> nodes,
                                 int lanes) {
  std::vector<LocalIndex> cells(static_cast<std::size_t>(end - begin));
  std::iota(cells.begin(), cells.end(), begin);
  auto order = batch_order(cells, nodes, 4, lanes);
  while (order.size() % static_cast<std::size_t>(lanes) != 0) order.push_back(-1);
  return order;
}

FilteredBlock::FilteredBlock(const ElasticCells& cells, std::span<const Vec3d> rest_positions,
                             const Material& material, const Damping& damping,
                             std::span<const CellClamp> clamps)
    : material_(material),
      damping_(damping),
      density_(cells.density),
      kernels_(filtered::kernels_for(material)),
      clamps_(clamps.begin(), clamps.end()),
      cell_of_lane_(lanes_of(0, cells.interior, cells.nodes, kernels_.lanes)),
      lane_of_cell_(clamps.size()),
      interior_{0, static_cast<LocalIndex>(cell_of_lane_.size()) / kernels_.lanes} {
  EVERT_ASSERT(cells.type == CellType::tet4 && 4 * clamps.size() == cells.nodes.size(),
               std::to_string(clamps.size()));
  const auto outer_cells = lanes_of(cells.interior, this->cells(), cells.nodes, lanes());
  cell_of_lane_.insert(cell_of_lane_.end(), outer_cells.begin(), outer_cells.end());
  fill_lanes(cells, rest_positions);
  if (damped()) damping_frames_.assign(9 * cell_of_lane_.size(), 0.0);
  arrays_ = {nodes_.data(), cell_of_lane_.data(), cells_.data(), bounds_.data(), damping_frames_.data()};
  set_filters();
  use_own_masses();
}

std::size_t FilteredBlock::place(LocalIndex cell, std::size_t numbers, std::size_t k) const {
  const auto lanes = static_cast<std::size_t>(kernels_.lanes);
  const auto slot = static_cast<std::size_t>(lane_of_cell_[static_cast<std::size_t>(cell)]);
  return (slot / lanes * numbers + k) * lanes + slot % lanes;
}

Vec3d FilteredBlock::read_vector(LocalIndex cell, std::size_t first) const {
  Vec3d vector;
  for (std::size_t i = 0; i < 3; ++i) vector[i] = cells_[place(cell, number::total, first + i)];
  return vector;
}

void FilteredBlock::write_vector(LocalIndex cell, std::size_t first, const Vec3d& vector) {
  for (std::size_t i = 0; i < 3; ++i) cells_[place(cell, number::total, first + i)] = vector[i];
}

void FilteredBlock::fill_lanes(const ElasticCells& cells, std::span<const Vec3d> rest_positions) {
  const std::size_t slots = cell_of_lane_.size();
  cells_.assign(number::total * slots, 0.0);
  bounds_.assign(bound::total * slots, 0.0);
  nodes_.resize(4 * slots);
  const auto lanes = static_cast<std::size_t>(kernels_.lanes);
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const bool padding = cell_of_lane_[slot] < 0;
    const LocalIndex cell = padding ? this->cells() - 1 : cell_of_lane_[slot];
    const auto nodes = cells.nodes.subspan(4 * static_cast<std::size_t>(cell), 4);
    for (std::size_t a = 0; a < 4; ++a) nodes_[(slot / lanes * 4 + a) * lanes + slot % lanes] = nodes[a];
    if (padding) continue;
    lane_of_cell_[static_cast<std::size_t>(cell)] = static_cast<LocalIndex>(slot);
    const TetShape shape = tet_shape(nodes, rest_positions);
    for (std::size_t a = 1; a < 4; ++a)
      write_vector(cell, number::gradients + 3 * (a - 1), shape.gradients[a]);
    cells_[place(cell, number::total, number::volume)] = shape.volume;
  }
}

/// As it is turned.
Cell FilteredBlock::at(LocalIndex cell) const {
  Cell read;
  for (std::size_t a = 1; a < 4; ++a) {
    read.gradients[a] = read_vector(cell, number::gradients + 3 * (a - 1));
    read.gradients[0] -= read.gradients[a];
  }
  read.volume = cells_[place(cell, number::total, number::volume)];
  for (std::size_t j = 0; j < 3; ++j)
    read.filter.stretch.column[j] = read_vector(cell, number::stretch + 3 * j);
  read.filter.shear = read_vector(cell, number::shear);
  return read;
}

/// The filters of the present material, each cell turned along its axes: they are the axes of its strains,
/// and what is kept of them is that they are none any more.
void FilteredBlock::set_filters() {
  const Lame lame = lame_of(material_);
  for (LocalIndex c = 0; c < cells(); ++c) {
    const auto& [masses, limit] = clamps_[static_cast<std::size_t>(c)];
    const Cell cell = at(c);
    const StrainFilter filter =
        strain_filter(element_modes({cell.gradients, cell.volume}, masses, lame), lame, limit);
    for (std::size_t a = 1; a < 4; ++a)
      write_vector(c, number::gradients + 3 * (a - 1), transpose_times(filter.axes, cell.gradients[a]));
    for (std::size_t j = 0; j < 3; ++j) write_vector(c, number::stretch + 3 * j, filter.stretch.column[j]);
    write_vector(c, number::shear, filter.shear);
  }
}

void FilteredBlock::damping_matrix(LocalIndex cell, std::span<double> matrix) const {
  std::fill(matrix.begin(), matrix.end(), 0.0);
  if (!damped()) return;
  const Cell of = at(cell);
  Mat3d frame;
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) frame(i, j) = damping_frames_[place(cell, 9, 3 * j + i)];
  filtered::fill_matrix(
      of,
      [&](const Mat3d& rate) {
        return filtered::viscous_stress(of.filter, frame, rate, of.volume * damping_.alpha,
                                        of.volume * damping_.beta);
      },
      matrix);
}

void FilteredBlock::stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const {
  std::array<double, 144> matrix;
  visit_isotropic(material_, [&](const auto& model) {
    for (LocalIndex c = 0; c < cells(); ++c) {
      const Cell cell = at(c);
      const auto svd = svd3(filtered::deformation_gradient(cell, cell_nodes(c), x));
      const filtered::Tangent tangent(model, cell, svd, form == TangentForm::projected);
      filtered::fill_matrix(
          cell, [&](const Mat3d& change) { return cell.volume * tangent(change); }, matrix);
      take(c, matrix);
    }
  });
}

CellNodes FilteredBlock::cell_nodes(LocalIndex cell) const {
  CellNodes nodes(4);
  for (std::size_t a = 0; a < 4; ++a) nodes[a] = nodes_[place(cell, 4, a)];
  return nodes;
}

StableStep FilteredBlock::stable_step(const double* x) const {
  // Of E = 0 nothing limits the step.
  const double stiffness =
      lame_of(material_).mu > 0 ? kernels_.largest_stiffness(arrays_, material_, x, all()) : 0;
  // Damping would raise the limit; what is filtered gets no credit for it.
  const double limit = 2 / std::sqrt(stiffness);
  return {limit, limit};
}

void FilteredBlock::set_mass_shares(std::span<const double> shares) {
  const Lame lame = lame_of(material_);
  for (LocalIndex c = 0; c < cells(); ++c) {
    const Cell cell = at(c);
    TetMasses masses{};
    std::copy_n(shares.begin() + 4 * static_cast<std::ptrdiff_t>(c), 4, masses.begin());
    for (std::size_t a = 0; a < 4; ++a)
      bounds_[place(c, bound::total, bound::inverse_masses + a)] = 1 / masses[a];
    bounds_[place(c, bound::total, bound::largest)] =
        largest_eigenvalue({cell.gradients, cell.volume}, masses, lame, {cell.filter, identity<double>()});
  }
}

void FilteredBlock::use_own_masses() {
  std::vector<double> shares;
  for (LocalIndex c = 0; c < cells(); ++c)
    shares.insert(shares.end(), 4, density_ * cells_[place(c, number::total, number::volume)] / 4);
  set_mass_shares(shares);
}

void FilteredBlock::set_material(const Material& material, const Damping& damping) {
  EVERT_ASSERT(material.index() == material_.index() && damping.model == damping_.model,
               std::to_string(material.index()) + " for " + std::to_string(material_.index()));
  material_ = material;
  damping_ = damping;
  set_filters();
  use_own_masses();
}

std::size_t FilteredBlock::memory() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  return bytes(clamps_) + bytes(cell_of_lane_) + bytes(lane_of_cell_) + bytes(nodes_) + bytes(cells_) +
         bytes(bounds_) + bytes(damping_frames_);
}

}  // namespace

std::unique_ptr<ElasticBlock> make_filtered_block(const ElasticCells& cells,
                                                  std::span<const Vec3d> rest_positions,
                                                  const Material& material, const Damping& damping,
                                                  std::span<const CellClamp> clamps) {
  return std::make_unique<FilteredBlock>(cells, rest_positions, material, damping, clamps);
}

}  // namespace evert
