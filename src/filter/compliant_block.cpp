#include "evert/filter/compliant_block.hpp"

#include "evert/core/error.hpp"
#include "evert/filter/stiff_modes.hpp"
#include "evert/forces/kernels/tangent_bound.hpp"
#include "evert/forces/plastic_cells.hpp"
#include "evert/math/eigen_symmetric3.hpp"
#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace evert {
namespace {

/// What the bound of a cell needs.
struct Cell {
  std::array<LocalIndex, 4> nodes{};
  TetShape shape{};
  CellClamp clamp;
  StrainFilter filter{};
  double explicit_part = 0;  ///< λ of K'_e against the shares of mass [1/s²]
  double middle = 0;         ///< V Γ₂ against them [m/kg]
};

class ImplicitStiffnessBlock final : public CompliantBlock {
 public:
  ImplicitStiffnessBlock(std::unique_ptr<ElasticBlock> forces, const ElasticCells& cells,
                         std::span<const TetShape> shapes, std::span<const CellClamp> clamps)
      : forces_(std::move(forces)),
        cells_(clamps.size()),
        own_masses_(4 * clamps.size()),
        shares_(4 * clamps.size()) {
    EVERT_ASSERT(cells.nodes.size() == 4 * clamps.size(), std::to_string(clamps.size()));
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const auto nodes = cells.nodes.subspan(4 * c, 4);
      std::copy(nodes.begin(), nodes.end(), cells_[c].nodes.begin());
      std::fill_n(own_masses_.begin() + static_cast<std::ptrdiff_t>(4 * c), 4,
                  cells.density * shapes[c].volume / 4);
    }
    shares_ = own_masses_;
    reshape(shapes, clamps);
  }

  void reshape(std::span<const TetShape> shapes, std::span<const CellClamp> clamps) override {
    EVERT_ASSERT(shapes.size() == cells_.size() && clamps.size() == cells_.size(),
                 std::to_string(shapes.size()));
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      cells_[c].shape = shapes[c];
      cells_[c].clamp = clamps[c];
    }
    set_filters();
    set_mass_shares(std::vector<double>(shares_));
  }

  [[nodiscard]] double rest_stiffness_of(LocalIndex cell) const override {
    return cells_[static_cast<std::size_t>(cell)].explicit_part;
  }
  [[nodiscard]] StableStep stable_step(const double* x) const override;
  void set_mass_shares(std::span<const double> shares) override;
  void set_material(const Material& material, const Damping& damping) override {
    forces_->set_material(material, damping);
    set_filters();
    set_mass_shares(own_masses_);
  }

  // All else is that of the forces.
  [[nodiscard]] BatchRange interior() const override { return forces_->interior(); }
  [[nodiscard]] BatchRange boundary() const override { return forces_->boundary(); }
  void update(const double* x, double* f, BatchRange batches) override { forces_->update(x, f, batches); }
  [[nodiscard]] CellType type() const override { return forces_->type(); }
  [[nodiscard]] const Material& material() const override { return forces_->material(); }
  [[nodiscard]] const Damping& damping() const override { return forces_->damping(); }
  [[nodiscard]] bool damped() const override { return forces_->damped(); }
  void add_damping(const double* v, double* out, double factor, BatchRange batches) const override {
    forces_->add_damping(v, out, factor, batches);
  }
  void add_damping_diagonal(double* normal, double* shear, double factor) const override {
    forces_->add_damping_diagonal(normal, shear, factor);
  }
  void damping_matrix(LocalIndex cell, std::span<double> matrix) const override {
    forces_->damping_matrix(cell, matrix);
  }
  void stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const override {
    forces_->stiffness_matrices(x, form, take);
  }
  [[nodiscard]] CellNodes cell_nodes(LocalIndex cell) const override { return forces_->cell_nodes(cell); }
  [[nodiscard]] LocalIndex cells() const override { return forces_->cells(); }
  [[nodiscard]] double energy(const double* x) const override { return forces_->energy(x); }
  void min_stretch(const double* x, std::span<double> per_cell) const override {
    forces_->min_stretch(x, per_cell);
  }
  [[nodiscard]] LocalIndex inverted_points(const double* x) const override {
    return forces_->inverted_points(x);
  }
  [[nodiscard]] double max_strain_rate(const double* x, const double* v) const override {
    return forces_->max_strain_rate(x, v);
  }
  void set_activation(double activation) override { forces_->set_activation(activation); }
  [[nodiscard]] PlasticCells* plastic() override { return forces_->plastic(); }
  [[nodiscard]] std::size_t memory() const override {
    return forces_->memory() + cells_.capacity() * sizeof(Cell) + 2 * own_masses_.capacity() * sizeof(double);
  }

 private:
  void set_filters();
  /// By how much a cell can have become stiffer since it was shaped as it is here.
  [[nodiscard]] double flown_since(std::size_t cell) const {
    const PlasticCells* plastic = std::as_const(*forces_).plastic();
    return plastic != nullptr ? stiffness_growth(plastic->way(static_cast<LocalIndex>(cell)), lame()) : 1;
  }
  [[nodiscard]] Lame lame() const {
    return std::visit([](const auto& model) { return model.lame; }, forces_->material());
  }

  std::unique_ptr<ElasticBlock> forces_;
  std::vector<Cell> cells_;
  std::vector<double> own_masses_;  // ρV/4, four a cell
  std::vector<double> shares_;      // of the masses of the nodes, four a cell
};

/// Of the present material.
void ImplicitStiffnessBlock::set_filters() {
  for (auto& cell : cells_)
    cell.filter =
        strain_filter(element_modes(cell.shape, cell.clamp.masses, lame()), lame(), cell.clamp.limit);
}

void ImplicitStiffnessBlock::set_mass_shares(std::span<const double> shares) {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    auto& cell = cells_[c];
    TetMasses masses{};
    std::copy_n(shares.begin() + static_cast<std::ptrdiff_t>(4 * c), 4, masses.begin());
    Mat3d squares{};
    for (std::size_t a = 0; a < 4; ++a)
      squares += (1 / masses[a]) * outer(cell.shape.gradients[a], cell.shape.gradients[a]);
    cell.explicit_part = largest_eigenvalue(cell.shape, masses, lame(), cell.filter);
    cell.middle = cell.shape.volume * eigen_symmetric3(squares).values[1];
  }
  shares_.assign(shares.begin(), shares.end());
  forces_->set_mass_shares(shares);
}

/// K ⪯ growth (K' + K_s) + spin 4 V Γ₂ M*, of which growth K_s is on the implicit side and limits nothing.
StableStep ImplicitStiffnessBlock::stable_step(const double* x) const {
  double largest = 0;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const auto& cell = cells_[c];
    Mat3d gradient{};
    const auto at = [&](std::size_t a) {
      const double* node = x + 3 * static_cast<std::ptrdiff_t>(cell.nodes[a]);
      return Vec3d{node[0], node[1], node[2]};
    };
    for (std::size_t a = 1; a < 4; ++a) gradient += outer(at(a) - at(0), cell.shape.gradients[a]);
    const auto now = stiffness_now(forces_->material(), svd3(gradient).sigma);
    const double of_cell = flown_since(c) * now.growth * cell.explicit_part + 4 * now.spin * cell.middle;
    largest =
        std::max(largest, of_cell < kernels::unresolvable<double> ? of_cell : kernels::unresolvable<double>);
  }
  // Damping would raise the limit; here it gets no credit for it.
  const double limit = 2 / std::sqrt(largest);
  return {limit, limit};
}

}  // namespace

std::unique_ptr<CompliantBlock> make_compliant_block(std::unique_ptr<ElasticBlock> forces,
                                                     const ElasticCells& cells,
                                                     std::span<const TetShape> shapes,
                                                     std::span<const CellClamp> clamps) {
  return std::make_unique<ImplicitStiffnessBlock>(std::move(forces), cells, shapes, clamps);
}

}  // namespace evert
