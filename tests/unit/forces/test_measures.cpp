#include "evert/math/svd3.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include <numeric>

/// Inversion, stretch, rate of strain and mass.
namespace evert::test {
namespace {

Body small_body(CellType type) { return type == CellType::tet4 ? box(type, 3, 2, 2) : box(type, 4, 3, 1); }

/// F in long double at every point of every cell.
std::vector<std::vector<Mat3<long double>>> deformation_gradients(const Body& body, const NodalValues& x) {
  std::vector<std::vector<Mat3<long double>>> all;
  const auto precise = [](const Vec3d& v) { return Vec3<long double>{v[0], v[1], v[2]}; };
  with_reference_element(body.type,
                         [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
                           for (LocalIndex c = 0; c < body.cells(); ++c) {
                             all.emplace_back();
                             for (std::size_t q = 0; q < points; ++q) {
                               Mat3<long double> rest{}, now{};
                               for (std::size_t a = 0; a < nodes; ++a) {
                                 const auto node = static_cast<std::size_t>(body.cell(c)[a]);
                                 rest += outer(precise(body.rest[node]), precise(element.gradients[q][a]));
                                 now += outer(precise(at_node(x, node)), precise(element.gradients[q][a]));
                               }
                               all.back().push_back(now * inverse(rest));
                             }
                           }
                         });
  return all;
}

TEST(MinStretch, IsTheSmallestSignedSingularValueAndCountsTheInverted) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    for (const auto& level : supported_levels()) {
      const auto block = level_block(level, body, NeoHookean{.lame = soft}, no_damping, 7);
      for (const State& state : awkward_states(body)) {
        std::vector<double> stretch(static_cast<std::size_t>(body.cells()), 99);
        block->min_stretch(state.x.data(), stretch);
        LocalIndex inverted = 0;
        const auto gradients = deformation_gradients(body, state.x);
        for (std::size_t c = 0; c < gradients.size(); ++c) {
          long double smallest = std::numeric_limits<long double>::infinity();
          for (const auto& f : gradients[c]) {
            const auto svd = svd3(f);
            smallest = std::min(smallest, svd.sigma[2]);
            // Flat to rounding is not inverted.
            inverted += svd.sigma[2] < -1e-14L * svd.sigma[0] ? 1 : 0;
          }
          EXPECT_NEAR(stretch[c], static_cast<double>(smallest), 1e-13) << state.name << ", " << level.name;
        }
        EXPECT_EQ(block->inverted_points(state.x.data()), inverted) << state.name << ", " << level.name;
      }
    }
  }
}

TEST(InvertedPoints, CountsAMirroredBodyWhole) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const auto block =
        make_elastic_block(body.elastic_cells(3), body.rest, NeoHookean{.lame = soft}, no_damping);
    const LocalIndex points = body.cells() * points_per_cell(type);
    EXPECT_EQ(block->inverted_points(nodal_values(body.rest).data()), 0);
    const auto mirrored = [&](double scale) {
      return deformed(body, [=](const Vec3d& p) { return Vec3d{p[0], -scale * p[1], p[2]}; });
    };
    EXPECT_EQ(block->inverted_points(mirrored(1).data()), points);
    EXPECT_EQ(block->inverted_points(mirrored(1e-9).data()), points);
    EXPECT_EQ(block->inverted_points(mirrored(0).data()), 0);
    const NodalValues point_mirrored = deformed(body, [](const Vec3d& p) { return -1e-3 * p; });
    EXPECT_EQ(block->inverted_points(point_mirrored.data()), points);
    // Thin in two directions: the sign of the determinant, 1e-22, is known all the same.
    const NodalValues thread = deformed(body, [](const Vec3d& p) {
      return Vec3d{-1e-11 * p[0], 1e-11 * p[1], p[2]};
    });
    EXPECT_EQ(block->inverted_points(thread.data()), points);
  }
}

/// Every way to find Q: from F, from the damping's gradients, from its frames.
class MaxStrainRate : public testing::TestWithParam<DampingModel> {};

TEST_P(MaxStrainRate, IsThatOfTheStretchesAndIgnoresRotation) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    for (const auto& level : supported_levels()) {
      const auto block = level_block(level, body, NeoHookean{.lame = soft}, {GetParam(), 1, 1}, 7);
      const auto rate = [&](const NodalValues& x, std::span<const Vec3d> v) {
        NodalValues f = zeros(body.rest.size());
        for (const auto part : {block->interior(), block->boundary()})
          block->update(x.data(), f.data(), part);
        return block->max_strain_rate(x.data(), nodal_values(v).data());
      };
      const Mat3d turn = rotation(1.1);
      const auto stretched = [&](const Vec3d& p) {
        return turn * Vec3d{1.5 * p[0], 0.5 * p[1], -0.2 * p[2]};
      };
      const NodalValues x = deformed(body, stretched);
      std::vector<Vec3d> stretching;
      for (const Vec3d& rest : body.rest) stretching.push_back(turn * Vec3d{0, 0, 7 * rest[2]});
      EXPECT_NEAR(rate(x, stretching), 7, 1e-12) << level.name;
      // Relative where stretched: one node of a flat cell moves it by many times its height.
      const NodalValues drawn = deformed(body, [&](const Vec3d& p) {
        return turn * Vec3d{p[0], 0.5 * p[1], 50 * p[2]};
      });
      EXPECT_NEAR(rate(drawn, stretching), 7.0 / 50, 1e-12) << level.name;
      std::vector<Vec3d> shearing;
      for (const Vec3d& rest : body.rest) shearing.push_back(turn * Vec3d{0, 6 * rest[2], 0});
      EXPECT_NEAR(rate(drawn, shearing), 6 / std::sqrt(2.0 * 50), 1e-12) << level.name;
      // On a state that is not stretched uniformly a rotation turns the axes, but changes no stretch.
      const NodalValues uniform = deformed(body, [&](const Vec3d& p) { return 0.7 * (turn * p); });
      std::vector<Vec3d> spin_uniform;
      for (std::size_t node = 0; node < body.rest.size(); ++node) {
        spin_uniform.push_back(cross(Vec3d{3, -1, 2}, at_node(uniform, node)));
      }
      EXPECT_NEAR(rate(uniform, spin_uniform), 0, 1e-12) << level.name;
      EXPECT_NEAR(rate(x, std::vector<Vec3d>(body.rest.size(), Vec3d{1, 2, 3})), 0, 1e-13) << level.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, MaxStrainRate,
                         testing::Values(DampingModel::none, DampingModel::rotated, DampingModel::objective));

TEST(LumpedMass, IsPositiveAndSumsToTheMassAndItsMoment) {
  for (const CellType type : all_elements) {
    const Body body = box(type, 3, 2, 4, 0.1, 0.0);
    std::vector<double> mass(body.rest.size(), 0.0);
    add_lumped_mass(body.elastic_cells(), body.rest, mass);
    Vec3d moment{};
    for (std::size_t node = 0; node < mass.size(); ++node) {
      EXPECT_GT(mass[node], 0);
      moment += mass[node] * body.rest[node];
    }
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
    EXPECT_NEAR(total, 1000 * 0.3 * 0.2 * 0.4, 1e-12);
    if (type == CellType::hex8) {
      EXPECT_NEAR(norm(moment - total * Vec3d{0.15, 0.1, 0.2}), 0, 1e-13 * total);
    }
    add_lumped_mass(body.elastic_cells(), body.rest, mass);
    EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.0), 2 * total, 1e-12) << "adds";
  }
}

TEST(Memory, PerTetrahedron) {
  const Body body = box(CellType::tet4, 8, 8, 8);
  const auto bytes = [&](const Damping& damping) {
    const auto block = make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, damping);
    return static_cast<double>(block->memory()) / body.cells();
  };
  // Nodes, shape gradients, volume, number of the cell and back, the two stiffnesses of the stable step.
  EXPECT_NEAR(bytes(no_damping), 4 * 4 + 6 * 8 + 8 + 4 + 4 + 2 * 4, 1);
  EXPECT_NEAR(bytes(rotated_damping), bytes(no_damping) + 72, 1);
}

}  // namespace
}  // namespace evert::test
