#include "kernel_subjects.hpp"

#include "evert/bench/level_kernels.hpp"
#include "evert/core/collective.hpp"
#include "evert/filter/filtered_block.hpp"
#include "evert/forces/plastic_cells.hpp"

#include <algorithm>
#include <limits>

namespace evert::bench {
namespace {

// No kernel takes another time for another of these.
constexpr double density = 1000;           // [kg/m^3]
constexpr double damping_time = 0.01;      // [s] stiffness-proportional
constexpr double damping_factor = 0.5e-3;  // [s] s of M + s C: half a step
// Calls of some 10 µs.
constexpr std::size_t multiply_add_steps = 3000;
constexpr std::size_t division_steps = 100;
constexpr NeoHookean material{.lame = Lame::from_young_poisson(1e5, 0.4)};

ElasticForces elastic(const Specimen& specimen, const Material& of_cells) {
  const ElasticProperties all{density, of_cells, {}};
  return {specimen.mesh, std::span(&all, 1)};
}

std::vector<std::unique_ptr<MaterialForces>> forces_of(const Specimen& specimen,
                                                       const std::vector<Material>& materials) {
  std::vector<std::unique_ptr<MaterialForces>> all;
  for (const Material& one : materials)
    all.push_back(std::unique_ptr<MaterialForces>(new MaterialForces{one, elastic(specimen, one)}));
  return all;
}

ElasticProperties properties(DampingModel damping) {
  return {density, material,
          damping == DampingModel::none ? Damping{}
                                        : Damping::stiffness_proportional(
                                              damping, damping_time, material.lame.lambda, material.lame.mu)};
}

ElasticForces elastic(const Specimen& specimen, DampingModel damping) {
  const auto all = properties(damping);
  return {specimen.mesh, std::span(&all, 1)};
}

/// Every cell of the rank clamped to half of its largest eigenvalue.
FilteredForces filtered(const Specimen& specimen, const Material& of_cells) {
  const auto& cells = specimen.mesh.cells.front();
  const Lame lame = std::visit([](const auto& model) { return model.lame; }, of_cells);
  std::vector<CellClamp> clamps;
  for (std::size_t first = 0; first < cells.nodes.size(); first += 4) {
    const auto shape = tet_shape(std::span(cells.nodes).subspan(first, 4), specimen.mesh.rest_positions);
    TetMasses masses{};
    masses.fill(density * shape.volume / 4);
    clamps.push_back({masses, 0.5 * element_modes(shape, masses, lame).largest()});
  }
  return {of_cells, make_filtered_block({cells.type, cells.nodes, cells.interior, density, {}},
                                        specimen.mesh.rest_positions, of_cells, Damping{}, clamps)};
}

std::vector<FilteredForces> all_filtered(const Specimen& specimen) {
  std::vector<FilteredForces> all;
  all.push_back(filtered(specimen, material));
  for (const Material& one : other_materials())
    if (!has_fibres(one)) all.push_back(filtered(specimen, one));
  return all;
}

std::unique_ptr<ElasticBlock> plastic_block(const Specimen& specimen, double yield) {
  const auto& cells = specimen.mesh.cells.front();
  ElasticCells of_block{cells.type, cells.nodes, cells.interior, density, {}};
  of_block.plasticity = Plasticity{.yield = yield};
  auto block = make_elastic_block(of_block, specimen.mesh.rest_positions, material, Damping{});
  block->plastic()->set_times(0, 1);
  return block;
}

PlasticForces not_yielding(const Specimen& specimen) {
  const auto x = specimen.positions.local();
  AlignedVector<double> same(x.begin(), x.end());
  same.push_back(0);  // the slack of NodeField
  return {plastic_block(specimen, std::numeric_limits<double>::infinity()), {same, same}};
}

/// Sheared to and fro.
PlasticForces flowing(const Specimen& specimen) {
  constexpr double shear = 0.2;
  std::array<AlignedVector<double>, 2> shapes;
  for (auto& x : shapes) {
    for (const Vec3d& rest : specimen.mesh.rest_positions)
      x.insert(x.end(), {rest[0] + (&x == shapes.data() ? shear : -shear) * rest[1], rest[1], rest[2]});
    x.push_back(0);  // the slack of NodeField
  }
  return {plastic_block(specimen, 0.01), std::move(shapes)};
}

/// The same number on every rank, for parts of some thousand cells.
std::size_t parts_of(const DistributedMesh& mesh) {
  constexpr GlobalIndex cells_of_part = 4096;
  const GlobalIndex parts = mesh.total_cells / (size_of(mesh.comm) * cells_of_part);
  return static_cast<std::size_t>(std::max<GlobalIndex>(1, parts));
}

}  // namespace

Material bench_material() { return material; }

std::vector<Material> other_materials() {
  const Lame& lame = material.lame;
  std::vector<Material> all{RotatedLinear{.lame = lame}, StVenantKirchhoff{.lame = lame},
                            MooneyRivlin{.lame = lame}, Spline{.lame = lame}, StableNeoHookean{.lame = lame}};
  for (const Material& one : materials_with_fibres()) all.push_back(one);
  return all;
}

std::vector<Material> materials_with_fibres() {
  return {Muscle{.lame = material.lame, .activation = 0.5}, Tendon{.lame = material.lame}};
}

TetSubject::TetSubject(MPI_Comm comm, int divisions)
    : specimen_(comm, CellType::tet4, divisions),
      result_(specimen_.mesh),
      plain_(elastic(specimen_, DampingModel::none)),
      damped_(elastic(specimen_, DampingModel::rotated)),
      others_(forces_of(specimen_, other_materials())),
      filtered_(all_filtered(specimen_)),
      not_yielding_(not_yielding(specimen_)),
      flowing_(flowing(specimen_)),
      operator_(specimen_.mesh, damped_),
      assembled_(operator_, MATBAIJ),
      naive_(specimen_.mesh.cells.front().nodes, specimen_.mesh.rest_positions, material),
      naive_result_(result_.local().size()),
      naive_parts_(naive_.cells(), parts_of(specimen_.mesh)),
      svd_parts_(naive_parts_) {
  damped_force();  // C is that of the last update
  operator_.set(damping_factor, {});
  assembled_.assemble();
  for (std::size_t cell = 0; cell < naive_.cells(); ++cell)
    gradients_.push_back(naive_.deformation_gradient(specimen_.positions.local(), cell));
}

double TetSubject::inverted() const {
  GlobalIndex count = plain_.inverted_points(specimen_.positions);
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, specimen_.mesh.comm);
  return static_cast<double>(count) / cells();
}

KernelCost TetSubject::baij_cost() const {
  MatInfo info{};
  check(MatGetInfo(assembled_.mat(), MAT_GLOBAL_SUM, &info));
  // A multiplication and an addition for each entry; a column number for each block of nine.
  const double bytes = (sizeof(PetscScalar) + sizeof(PetscInt) / 9.0) * info.nz_used;
  return {2 * info.nz_used / cells(), 0, bytes / cells()};
}

void TetSubject::force(const FilteredForces& of) {
  std::ranges::fill(result_.local(), 0.0);
  const double* x = specimen_.positions.local().data();
  of.block->update(x, result_.local().data(), of.block->interior());
  of.block->update(x, result_.local().data(), of.block->boundary());
}

void TetSubject::force(PlasticForces& of) {
  std::ranges::fill(result_.local(), 0.0);
  const double* x = of.positions[of.turn].data();
  of.turn = 1 - of.turn;
  of.block->update(x, result_.local().data(), of.block->interior());
  of.block->update(x, result_.local().data(), of.block->boundary());
}

void TetSubject::damping() {
  std::ranges::fill(result_.owned(), 0.0);
  damped_.add_damping(specimen_.velocities, result_, damping_factor);
}

void TetSubject::naive_force_part() {
  const auto [begin, end] = naive_parts_.next();
  if (begin == 0) std::ranges::fill(naive_result_, 0.0);
  naive_.add(specimen_.positions.local(), naive_result_, begin, end);
}

// As a kernel that needs U and V goes on with them: a run at a time, before they leave the cache.
void TetSubject::svd_part() {
  constexpr std::size_t run = 64;
  decompositions_.resize(run);
  const auto [begin, end] = svd_parts_.next();
  for (std::size_t first = begin; first < end; first += run) {
    const auto piece = std::span(gradients_).subspan(first, std::min(run, end - first));
    svd3_batch(piece, std::span(decompositions_).first(piece.size()));
  }
}

ElementSubject::ElementSubject(MPI_Comm comm, CellType type, int divisions)
    : type_(type),
      specimen_(comm, type, divisions),
      result_(specimen_.mesh),
      plain_(elastic(specimen_, DampingModel::none)) {}

HexSubject::HexSubject(MPI_Comm comm, int divisions)
    : ElementSubject(comm, CellType::hex8, divisions),
      others_(forces_of(specimen_, materials_with_fibres())) {
  const auto& cells = specimen_.mesh.cells.front();
  general_ =
      make_elastic_block({cells.type, cells.nodes, cells.interior, density}, specimen_.mesh.rest_positions,
                         material, Damping{}, level_kernels().general_hex);
}

void HexSubject::general_force() {
  std::ranges::fill(result_.local(), 0.0);
  const double* x = specimen_.positions.local().data();
  general_->update(x, result_.local().data(), general_->interior());
  general_->update(x, result_.local().data(), general_->boundary());
}

CeilingSubject::CeilingSubject(std::size_t memory) {
  const std::size_t count = std::max<std::size_t>(1, memory / (3 * sizeof(double) * 8)) * 8;
  a_.assign(count, 0.0);
  b_.assign(count, 1.0);
  c_.assign(count, 2.0);
}

double CeilingSubject::flops() { return multiply_add_steps * level_kernels().flops_per_step; }

double CeilingSubject::divisions() { return division_steps * level_kernels().divisions_per_step; }

// The cache line of a[i] is read before it is written.
double CeilingSubject::triad_bytes() const { return 4.0 * sizeof(double) * static_cast<double>(a_.size()); }

void CeilingSubject::multiply_add() { sum_ += level_kernels().multiply_add(multiply_add_steps); }

void CeilingSubject::divide_and_root() { sum_ += level_kernels().divide_and_root(division_steps); }

void CeilingSubject::triad() { level_kernels().triad(a_.data(), b_.data(), c_.data(), 0.5, a_.size()); }

}  // namespace evert::bench
