#include "batched_block.hpp"

#include "evert/core/error.hpp"
#include "evert/elements/reference_element.hpp"

#include "rest_point.hpp"
#include "stiffness_matrix.hpp"
#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace evert {
namespace {

/// What rest stiffness is made of.
Lame lame_of(const Material& material) {
  return std::visit([](const auto& model) { return model.lame.regular(); }, material);
}

template <class Vector>
std::size_t bytes(const Vector& v) {
  return v.capacity() * sizeof(typename Vector::value_type);
}

/// A point of one cell as its damping operator sees it: with K_ab = V (β (h_b h_aᵀ + g_a·g_b A Aᵀ) + α h_a
/// h_bᵀ), h = A g.
struct DampingPoint {
  NodeVectors gradients;  ///< g_a
  Mat3d frame;            ///< A
  double volume;          ///< V

  [[nodiscard]] Mat3d block(std::size_t a, std::size_t b, const Damping& damping) const {
    const Vec3d ha = frame * gradients[a];
    const Vec3d hb = frame * gradients[b];
    const Mat3d shear = outer(hb, ha) + dot(gradients[a], gradients[b]) * times_transpose(frame, frame);
    return volume * (damping.beta * shear + damping.alpha * outer(ha, hb));
  }

  /// Adds all blocks to a dense row-major matrix.
  void add_to(std::size_t nodes, std::span<double> matrix, const Damping& damping) const {
    for (std::size_t a = 0; a < nodes; ++a) {
      for (std::size_t b = 0; b < nodes; ++b) {
        const Mat3d of_nodes = block(a, b, damping);
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t j = 0; j < 3; ++j) matrix[(3 * a + i) * 3 * nodes + 3 * b + j] += of_nodes(i, j);
        }
      }
    }
  }
};

}  // namespace

BatchedBlock::BatchedBlock(const ElementView& element, const ElasticCells& cells,
                           std::span<const Vec3d> rest_positions, const Material& material,
                           const Damping& damping, const kernels::ElasticKernels& kernels)
    : element_block_(make_element_block(element, cells.nodes, cells.interior, rest_positions, kernels.lanes,
                                        kernels.shape_data, kernels.precision)),
      material_(material),
      damping_(damping),
      density_(cells.density),
      mean_dilatation_(cells.mean_dilatation),
      kernels_(kernels),
      rest_stiffness_(
          rest_stiffness(element_block_, own_mass_shares(element_block_, density_), lame_of(material))),
      damping_state_(kernels.precision,
                     element_block_.cell_of_lane.size() * static_cast<std::size_t>(kernels.damping_numbers)),
      lane_of_cell_(static_cast<std::size_t>(element_block_.cells)) {
  for (std::size_t slot = 0; slot < element_block_.cell_of_lane.size(); ++slot) {
    const LocalIndex cell = element_block_.cell_of_lane[slot];
    if (cell >= 0) lane_of_cell_[static_cast<std::size_t>(cell)] = static_cast<LocalIndex>(slot);
  }
  if (kernels.fibres) set_fibres(element_block_, cells.fibres, rest_positions, kernels.precision);
  if (cells.plasticity) {
    EVERT_ASSERT(kernels.deform_shapes != nullptr, "plasticity of fibres or in mixed precision");
    plastic_ = std::make_unique<PlasticCells>(*cells.plasticity, element_block_, kernels.deform_shapes);
    set_mass_shares(own_mass_shares(element_block_, density_));
  }
  point_kernels_at_memory();
}

void BatchedBlock::point_kernels_at_memory() {
  arrays_ = {element_block_.nodes.data(),
             element_block_.shapes.data(),
             element_block_.volumes.data(),
             element_block_.cell_of_lane.data(),
             rest_stiffness_.largest.data(),
             rest_stiffness_.spin.data(),
             damping_state_.data(),
             element_block_.fibres.data(),
             plastic_ != nullptr ? plastic_->arrays() : nullptr,
             mean_dilatation_};
}

void BatchedBlock::update(const double* x, double* f, BatchRange batches) {
  kernels_.update(arrays_, material_, x, f, batches);
}

void BatchedBlock::add_damping(const double* v, double* out, double factor, BatchRange batches) const {
  if (damped()) kernels_.add_damping(arrays_, damping_, factor, v, out, batches);
}

void BatchedBlock::add_damping_diagonal(double* normal, double* shear, double factor) const {
  if (damped()) kernels_.add_damping_diagonal(arrays_, damping_, factor, normal, shear, all());
}

void BatchedBlock::damping_matrix(LocalIndex cell, std::span<double> matrix) const {
  std::fill(matrix.begin(), matrix.end(), 0.0);
  if (!damped()) return;
  const auto lanes = static_cast<std::size_t>(element_block_.lanes);
  const auto slot = static_cast<std::size_t>(lane_of_cell_[static_cast<std::size_t>(cell)]);
  const ElementView& element = element_block_.element;
  const LaneNumbers state(damping_state_, static_cast<std::size_t>(kernels_.damping_numbers), lanes, slot);
  const ShapeLayout full{
      .vectors = rest_layout(element_block_.shape_data, element.nodes(), element.points()).vectors};
  for (std::size_t q = 0; q < element.points(); ++q) {
    if (kernels_.rotated_gradients) {  // V is in the h_a already
      const auto h = read_gradients(element, element_block_.shape_data, full, state, q);
      DampingPoint{h, identity<double>(), 1}.add_to(element.nodes(), matrix, damping_);
    } else {
      const auto rest = rest_point(element_block_, slot, q);
      DampingPoint{rest.gradients, state.matrix(q), rest.volume}.add_to(element.nodes(), matrix, damping_);
    }
  }
}

void BatchedBlock::stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const {
  const std::size_t nodes = element_block_.element.nodes(), points = element_block_.element.points();
  std::array<double, 9 * most_nodes * most_nodes> of_cell;
  const std::span<double> matrix(of_cell.data(), 9 * nodes * nodes);
  const auto all_cells = [&](const auto& model) {
    for (LocalIndex cell = 0; cell < cells(); ++cell) {
      const auto slot = static_cast<std::size_t>(lane_of_cell_[static_cast<std::size_t>(cell)]);
      const NodeVectors at_nodes = nodal_values(x, cell_nodes(cell));
      std::fill(matrix.begin(), matrix.end(), 0.0);
      for (std::size_t q = 0; q < points; ++q) {
        add_stiffness(rest_point(element_block_, slot, q), nodes, at_nodes, fibre_at(slot, q), model, form,
                      matrix);
      }
      take(cell, matrix);
    }
  };
  std::visit(all_cells, material_);
}

/// As the cell in lane number `slot` is turned; none where the material has no fibres.
Vec3d BatchedBlock::fibre_at(std::size_t slot, std::size_t q) const {
  if (element_block_.fibres.size() == 0) return {0, 0, 0};
  constexpr ShapeLayout one_vector{.vectors = 1};
  const std::size_t points = element_block_.element.points();
  return LaneNumbers(element_block_.fibres, 3 * points, static_cast<std::size_t>(element_block_.lanes), slot)
      .vector(one_vector, q, 0);
}

CellNodes BatchedBlock::cell_nodes(LocalIndex cell) const {
  const auto lanes = static_cast<std::size_t>(element_block_.lanes);
  const auto slot = static_cast<std::size_t>(lane_of_cell_[static_cast<std::size_t>(cell)]);
  CellNodes nodes(element_block_.element.nodes());
  const std::size_t first = slot / lanes * lanes * nodes.size() + slot % lanes;
  for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = element_block_.nodes[first + a * lanes];
  return nodes;
}

double BatchedBlock::energy(const double* x) const { return kernels_.energy(arrays_, material_, x, all()); }

void BatchedBlock::min_stretch(const double* x, std::span<double> per_cell) const {
  EVERT_ASSERT(per_cell.size() == lane_of_cell_.size(), std::to_string(per_cell.size()));
  kernels_.min_stretch(arrays_, x, per_cell.data(), all());
}

LocalIndex BatchedBlock::inverted_points(const double* x) const {
  return kernels_.inverted_points(arrays_, x, all());
}

void BatchedBlock::follow_flow() const {
  if (plastic_ == nullptr) return;
  constexpr double much = 1.15;  // the step may be shorter by 7 % than it could be
  const Lame lame = lame_of(material_);
  for (std::size_t slot = 0; slot < element_block_.cell_of_lane.size(); ++slot) {
    const auto [largest, spin, drift] = plastic_->stiffness(slot);
    const double growth = drift > 0 ? stiffness_growth(drift, lame) : 1;
    if (growth > much) {
      update_rest_stiffness(element_block_, mass_shares_, lame, plastic_.get(), slot, rest_stiffness_);
      plastic_->settle(slot, rest_stiffness_.largest[slot], rest_stiffness_.spin[slot]);
    } else {
      rest_stiffness_.largest[slot] = static_cast<float>(growth) * largest;
      rest_stiffness_.spin[slot] = static_cast<float>(growth) * spin;
    }
  }
}

StableStep BatchedBlock::stable_step(const double* x) const {
  follow_flow();
  return kernels_.stable_step(arrays_, material_, damping_, x, all());
}

double BatchedBlock::max_strain_rate(const double* x, const double* v) const {
  return kernels_.max_strain_rate(arrays_, x, v, all());
}

void BatchedBlock::set_material(const Material& material, const Damping& damping) {
  EVERT_ASSERT(material.index() == material_.index() && damping.model == damping_.model,
               std::to_string(material.index()) + " for " + std::to_string(material_.index()));
  material_ = material;
  damping_ = damping;
  set_mass_shares(own_mass_shares(element_block_, density_));
}

double BatchedBlock::rest_stiffness_of(LocalIndex cell) const {
  const auto& largest = plastic_ != nullptr ? made_stiffness_ : rest_stiffness_.largest;
  return largest[static_cast<std::size_t>(lane_of_cell_[static_cast<std::size_t>(cell)])];
}

void BatchedBlock::set_mass_shares(std::span<const double> shares) {
  rest_stiffness_ = rest_stiffness(element_block_, shares, lame_of(material_), plastic_.get());
  if (plastic_ != nullptr) {
    mass_shares_.assign(shares.begin(), shares.end());
    for (std::size_t slot = 0; slot < element_block_.cell_of_lane.size(); ++slot)
      plastic_->settle(slot, rest_stiffness_.largest[slot], rest_stiffness_.spin[slot]);
    plastic_->exchange_shapes();
    made_stiffness_ = rest_stiffness(element_block_, shares, lame_of(material_)).largest;
    plastic_->exchange_shapes();
  }
  point_kernels_at_memory();
}

std::size_t BatchedBlock::memory() const {
  return bytes(element_block_.nodes) + element_block_.shapes.bytes() + element_block_.volumes.bytes() +
         element_block_.fibres.bytes() + bytes(element_block_.cell_of_lane) + bytes(rest_stiffness_.largest) +
         bytes(rest_stiffness_.spin) + damping_state_.bytes() + bytes(lane_of_cell_) + bytes(mass_shares_) +
         bytes(made_stiffness_) + (plastic_ != nullptr ? plastic_->memory() : 0);
}

std::unique_ptr<ElasticBlock> make_elastic_block(const ElementView& element, const ElasticCells& cells,
                                                 std::span<const Vec3d> rest_positions,
                                                 const Material& material, const Damping& damping,
                                                 const kernels::ElasticKernels& kernels) {
  return std::make_unique<BatchedBlock>(element, cells, rest_positions, material, damping, kernels);
}

std::unique_ptr<ElasticBlock> make_elastic_block(const ElasticCells& cells,
                                                 std::span<const Vec3d> rest_positions,
                                                 const Material& material, const Damping& damping,
                                                 const kernels::ElasticKernels& kernels) {
  return make_elastic_block(reference_element(cells.type), cells, rest_positions, material, damping, kernels);
}

}  // namespace evert
