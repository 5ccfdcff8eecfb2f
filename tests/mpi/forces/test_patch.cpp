// The patch test of every element and model, on distorted meshes and any number of ranks.
#include "evert/forces/elastic_forces.hpp"
#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"
#include "evert/mesh/boundary.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/quadratic.hpp"

#include <gtest/gtest.h>

#include "tests/support/verify.hpp"
#include <algorithm>
#include <functional>
#include <random>
#include <string>

namespace evert {
namespace {

/// Every other column of hexahedra along z becomes two wedges each.
void cut_columns(Mesh& mesh, int along_x) {
  CellBlock hexes{CellType::hex8, {}, {}}, wedges{CellType::wedge6, {}, {}};
  const CellBlock all = *mesh.block(CellType::hex8);
  for (std::size_t cell = 0; cell < all.region.size(); ++cell) {
    const auto v = std::span(all.nodes).subspan(8 * cell, 8);
    if (static_cast<int>(cell) % along_x % 2 == 0) {
      hexes.nodes.insert(hexes.nodes.end(), v.begin(), v.end());
      hexes.region.push_back(all.region[cell]);
      continue;
    }
    wedges.nodes.insert(wedges.nodes.end(), {v[0], v[1], v[2], v[4], v[5], v[6]});
    wedges.nodes.insert(wedges.nodes.end(), {v[0], v[2], v[3], v[4], v[6], v[7]});
    wedges.region.insert(wedges.region.end(), 2, all.region[cell]);
  }
  mesh.cells = {hexes, wedges};
}

/// Of the models that have fibres.
const Vec3d fibre{2.0 / 3, -1.0 / 3, 2.0 / 3};

Mesh make_mesh(const std::string& elements) {
  const auto cells = elements == "hex8" || elements == "mixed" ? BoxCells::hex8
                     : elements == "wedge6"                    ? BoxCells::wedge6
                                                               : BoxCells::tet6;
  Mesh mesh = generate_box({1, 0.75, 0.75}, {4, 3, 3}, cells);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> shift(-0.03, 0.03);
  for (auto& node : mesh.nodes) node += Vec3d{shift(random), shift(random), shift(random)};
  if (elements == "tet10") make_quadratic(mesh);
  if (elements == "mixed") cut_columns(mesh, 4);
  for (auto& block : mesh.cells) block.vectors.assign(block.region.size(), fibre);
  return mesh;
}

const std::vector<Material> models{
    RotatedLinear{.lame = Lame::from_young_poisson(1e4, 0.4)},
    NeoHookean{.lame = Lame::from_young_poisson(1e4, 0.4)},
    StVenantKirchhoff{.lame = Lame::from_young_poisson(1e4, 0.4)},
    MooneyRivlin{.lame = Lame::from_young_poisson(1e4, 0.4)},
    Spline{.lame = Lame::from_young_poisson(1e4, 0.4)},
    StableNeoHookean{.lame = Lame::from_young_poisson(1e4, 0.4)},
    Muscle{.lame = Lame::from_young_poisson(1e4, 0.4), .peak_stress = 1e4, .activation = 0.6},
    Tendon{.lame = Lame::from_young_poisson(1e4, 0.4), .peak_stress = 1e5}};

/// Large stretches, a shear, a turn of half a circle, and the same inside out and pressed flat.
const std::vector<Mat3d> deformations{
    {{{{1.7, 0.2, -0.1}, {0.4, 0.6, 0.3}, {-0.2, 0.1, 1.2}}}},
    {{{{-1, 0, 0}, {0, -1, 0}, {0.8, 0, 1}}}},
    {{{{1.1, 0.3, 0}, {0, 0.9, 0}, {0.2, 0, -0.7}}}},
    {{{{-0.8, 0.1, 0.2}, {0, -1.1, 0.1}, {0.3, 0, -0.9}}}},
    {{{{1.2, 0, 0}, {0, 1, 0}, {0.5, 0.4, 0}}}},
};

Mat3d first_piola(const Material& material, const Mat3d& f) {
  return std::visit([&](const auto& model) { return first_piola_kirchhoff(model, svd3(f), fibre); },
                    material);
}

class Patch : public testing::TestWithParam<std::string> {
 protected:
  Patch() : mesh_(distribute(PETSC_COMM_WORLD, whole_)), x_(mesh_), f_(mesh_) {
    surface_ = boundary_nodes(whole_);
  }

  [[nodiscard]] bool on_surface(LocalIndex node) const {
    return std::binary_search(surface_.begin(), surface_.end(),
                              mesh_.original_nodes[static_cast<std::size_t>(node)]);
  }

  Mesh whole_ = make_mesh(GetParam());
  DistributedMesh mesh_;
  NodeField x_, f_;
  std::vector<GlobalIndex> surface_;
};

TEST_P(Patch, AUniformDeformationIsInBalance) {
  double unbalanced = 0, stress_error = 0;
  for (const Material& material : models) {
    const ElasticProperties properties{1000, material, {}};
    ElasticForces elastic(mesh_, std::span(&properties, 1));
    double volume = 0;
    for (const double m : elastic.masses()) volume += m / 1000;
    MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    for (const Mat3d& f : deformations) {
      for (LocalIndex i = 0; i < mesh_.local_nodes(); ++i)
        set_node_value(x_.local(), i, f * mesh_.rest_positions[static_cast<std::size_t>(i)]);
      x_.touched();
      elastic.update(x_, f_);

      // Inside nothing is left over; on the surface the forces make up the stress, ∫ P dX = −Σ f Xᵀ.
      const Mat3d p = first_piola(material, f);
      const double scale = norm(p) * 0.25 * 0.25;  // a stress on the face of a cell
      Mat3d virial{};
      int inside = 0;
      for (LocalIndex i = 0; i < mesh_.owned_nodes; ++i) {
        const auto force = node_value(f_.owned(), i);
        if (!on_surface(i)) {
          EXPECT_LE(norm(force), 1e-12 * scale) << "node " << i;
          unbalanced = std::max(unbalanced, norm(force) / scale);
          ++inside;
        }
        virial -= outer(force, mesh_.rest_positions[static_cast<std::size_t>(i)]);
      }
      MPI_Allreduce(MPI_IN_PLACE, &virial, 9, MPI_DOUBLE, MPI_SUM, mesh_.comm);
      MPI_Allreduce(MPI_IN_PLACE, &inside, 1, MPI_INT, MPI_SUM, mesh_.comm);
      EXPECT_GE(inside, 3 * 2 * 2) << "the nodes of the lattice that are inside";
      EXPECT_LE(norm(virial - volume * p), 1e-12 * volume * norm(p));
      stress_error = std::max(stress_error, norm(virial - volume * p) / (volume * norm(p)));
    }
  }
  test::verify("patch test, " + GetParam() + ": force left inside, over stress on a face", "0", unbalanced,
               "<= 1e-12");
  test::verify("patch test, " + GetParam() + ": relative error of the stress", "0", stress_error, "<= 1e-12");
}

INSTANTIATE_TEST_SUITE_P(Elements, Patch, testing::Values("tet4", "hex8", "wedge6", "tet10", "mixed"),
                         [](const auto& elements) { return elements.param; });

}  // namespace
}  // namespace evert
