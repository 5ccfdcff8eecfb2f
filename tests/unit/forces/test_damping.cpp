#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "bodies.hpp"

/// The damping operator C(x): symmetric, positive semidefinite, the same matrix-free, as blocks and dense.
namespace evert::test {
namespace {

constexpr std::array all_models{rotated_damping, objective_damping, blended_damping};

std::string label(const Body& body, const Damping& damping, const std::string& state) {
  const std::string model = damping.model == DampingModel::rotated     ? ", rotated, "
                            : damping.model == DampingModel::objective ? ", objective, "
                                                                       : ", blended, ";
  return std::string(evert::name_of(body.type)) + model + state;
}

Body small_body(CellType type) { return type == CellType::tet4 ? box(type, 2, 2, 1) : box(type, 3, 2, 1); }

/// C by its columns.
Eigen::MatrixXd by_products(const ElasticBlock& block, std::size_t nodes) {
  const auto size = static_cast<Eigen::Index>(3 * nodes);
  Eigen::MatrixXd c(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    NodalValues unit = zeros(nodes);
    unit[static_cast<std::size_t>(j)] = 1;
    const NodalValues column = damping_product(block, unit);
    for (Eigen::Index i = 0; i < size; ++i) c(i, j) = column[static_cast<std::size_t>(i)];
  }
  return c;
}

/// C from the dense matrices of the cells.
Eigen::MatrixXd assembled(const ElasticBlock& block, std::size_t nodes) {
  const auto size = static_cast<Eigen::Index>(3 * nodes);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(size, size);
  for (LocalIndex cell = 0; cell < block.cells(); ++cell) {
    const auto of_cell = block.cell_nodes(cell);
    const std::size_t n = 3 * of_cell.size();
    std::vector<double> dense(n * n);
    block.damping_matrix(cell, dense);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        c(3 * of_cell[i / 3] + static_cast<Eigen::Index>(i % 3),
          3 * of_cell[j / 3] + static_cast<Eigen::Index>(j % 3)) += dense[i * n + j];
      }
    }
  }
  return c;
}

TEST(Damping, IsSymmetricAndPositiveSemidefinite) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    for (const Damping& damping : all_models) {
      const auto block =
          make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, damping);
      for (const State& state : awkward_states(body)) {
        forces(*block, state.x);
        const Eigen::MatrixXd c = by_products(*block, body.rest.size());
        const double scale = c.cwiseAbs().maxCoeff();
        EXPECT_LE((c - c.transpose()).cwiseAbs().maxCoeff(), 1e-14 * scale)
            << label(body, damping, state.name);
        const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(c).eigenvalues();
        EXPECT_GE(eigenvalues.minCoeff(), -1e-13 * eigenvalues.maxCoeff())
            << label(body, damping, state.name);
        if (damping.model != DampingModel::objective) {
          EXPECT_GT(scale, 0) << "robust when flat";
        }
      }
    }
  }
}

TEST(Damping, DenseMatricesAndDiagonalBlocksEqualTheProduct) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    for (const Damping& damping : all_models) {
      for (const auto& level : supported_levels()) {
        const auto block = level_block(level, body, NeoHookean{.lame = soft}, damping, 4);
        for (const State& state : awkward_states(body)) {
          forces(*block, state.x);
          const Eigen::MatrixXd c = by_products(*block, body.rest.size());
          const double scale = c.cwiseAbs().maxCoeff();
          EXPECT_LE((c - assembled(*block, body.rest.size())).cwiseAbs().maxCoeff(), 1e-14 * scale)
              << label(body, damping, state.name) << ", " << level.name;
          NodalValues normal(3 * body.rest.size() + 1, 1.0), shear = normal;
          block->add_damping_diagonal(normal.data(), shear.data(), 2.0);
          const auto entry = [&](std::size_t node, std::size_t row, std::size_t column) {
            return 1 + 2 * c(static_cast<Eigen::Index>(3 * node + row),
                             static_cast<Eigen::Index>(3 * node + column));
          };
          for (std::size_t node = 0; node < body.rest.size(); ++node) {
            for (std::size_t k = 0; k < 3; ++k) {
              const auto where = label(body, damping, state.name) + ", " + std::string(level.name);
              const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
              EXPECT_NEAR(normal[3 * node + k], entry(node, k, k), 1e-14 * (2 * scale + 1)) << where;
              EXPECT_NEAR(shear[3 * node + k], entry(node, i, j), 1e-14 * (2 * scale + 1)) << where;
            }
          }
        }
      }
    }
  }
}

/// PHYSICS 4, written out once more: P = U P̂ Vᵀ with P̂ = β(Ḟ̂ + Ḟ̂ᵀ) + α tr(Ḟ̂) I, Ḟ̂ = Uᵀ Ḟ V; and
/// P = F(2βĖ + α tr(Ė) I); blended with A in the place of both.
TEST(Damping, IsTheLawOfThePaper) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const NodalValues v = random_velocities(body.rest.size());
    for (const Damping& damping : all_models) {
      const auto block =
          make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, damping);
      for (const State& state : awkward_states(body)) {
        if (!state.unique) continue;
        forces(*block, state.x);
        NodalValues expected = zeros(body.rest.size());
        with_reference_element(
            type, [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
              for (LocalIndex c = 0; c < body.cells(); ++c) {
                const auto cell = body.cell(c);
                for (std::size_t q = 0; q < points; ++q) {
                  Mat3d rest{}, now{}, moving{};
                  for (std::size_t a = 0; a < nodes; ++a) {
                    const auto node = static_cast<std::size_t>(cell[a]);
                    rest += outer(body.rest[node], element.gradients[q][a]);
                    now += outer(at_node(state.x, node), element.gradients[q][a]);
                    moving += outer(at_node(v, node), element.gradients[q][a]);
                  }
                  const Mat3d f = now * inverse(rest), rate = moving * inverse(rest);
                  const auto [u, sigma, w] = svd3(f);
                  Mat3d stress;
                  if (damping.model == DampingModel::blended) {
                    double objective_share = 1;
                    for (const double s : sigma.components) {
                      const double from_flat = std::clamp((s - 0.1) / 0.4, 0.0, 1.0);
                      objective_share *= 3 * std::pow(from_flat, 2) - 2 * std::pow(from_flat, 3);
                    }
                    const Mat3d a = objective_share * f + (1 - objective_share) * u * transpose(w);
                    stress = a * (damping.beta * (transpose(rate) * a + transpose(a) * rate) +
                                  damping.alpha * trace(transpose(a) * rate) * identity<double>());
                  } else if (damping.model == DampingModel::rotated) {
                    const Mat3d turned = transpose(u) * rate * w;
                    stress = u *
                             (damping.beta * (turned + transpose(turned)) +
                              damping.alpha * trace(turned) * identity<double>()) *
                             transpose(w);
                  } else {
                    const Mat3d strain_rate = 0.5 * (transpose(rate) * f + transpose(f) * rate);
                    stress = f * (2 * damping.beta * strain_rate +
                                  damping.alpha * trace(strain_rate) * identity<double>());
                  }
                  for (std::size_t a = 0; a < nodes; ++a) {
                    const Vec3d force = element.weights[q] * determinant(rest) *
                                        (stress * transpose_times(inverse(rest), element.gradients[q][a]));
                    for (std::size_t i = 0; i < 3; ++i)
                      expected[3 * static_cast<std::size_t>(cell[a]) + i] += force[i];
                  }
                }
              }
            });
        EXPECT_LE(largest_difference(damping_product(*block, v), expected), 1e-13 * largest(expected))
            << label(body, damping, state.name);
      }
    }
  }
}

NodalValues rotating(const Body& body, const NodalValues& x, const Vec3d& angular_velocity) {
  std::vector<Vec3d> v;
  for (std::size_t node = 0; node < body.rest.size(); ++node)
    v.push_back(cross(angular_velocity, at_node(x, node)));
  return nodal_values(v);
}

TEST(Damping, LeavesRigidMotionAlone) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const NodalValues drift = nodal_values(std::vector<Vec3d>(body.rest.size(), Vec3d{1, -2, 3}));
    for (const Damping& damping : all_models) {
      const auto block =
          make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, damping);
      for (const State& state : awkward_states(body)) {
        forces(*block, state.x);
        EXPECT_EQ(largest(damping_product(*block, drift)), 0) << label(body, damping, state.name);
        const double scale = largest(damping_product(*block, random_velocities(body.rest.size())));
        const NodalValues turning = damping_product(*block, rotating(body, state.x, {1, -2, 3}));
        // `rotated` sees rotation unless the point is scaled uniformly, `blended` where flat or inverted.
        if (damping.model == DampingModel::objective) {
          EXPECT_LE(largest(turning), 1e-13 * (scale + 1)) << label(body, damping, state.name);
        }
      }
      const Mat3d turn_and_scale = 1.3 * rotation(2);
      const NodalValues x = deformed(body, [&](const Vec3d& p) { return turn_and_scale * p; });
      forces(*block, x);
      EXPECT_LE(largest(damping_product(*block, rotating(body, x, {1, -2, 3}))),
                1e-13 * largest(damping_product(*block, random_velocities(body.rest.size()))))
          << label(body, damping, "scaled uniformly");
    }
  }
}

TEST(Damping, ConservesMomentumAndObjectiveAlsoAngularMomentum) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const NodalValues v = random_velocities(body.rest.size());
    for (const Damping& damping : all_models) {
      const auto block =
          make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, damping);
      for (const State& state : awkward_states(body)) {
        forces(*block, state.x);
        const NodalValues force = damping_product(*block, v);
        Vec3d sum{}, torque{};
        for (std::size_t node = 0; node < body.rest.size(); ++node) {
          sum += at_node(force, node);
          torque += cross(at_node(state.x, node), at_node(force, node));
        }
        EXPECT_LE(norm(sum), 1e-13 * largest(force) * 10) << label(body, damping, state.name);
        if (damping.model == DampingModel::objective) {
          EXPECT_LE(norm(torque), 1e-13 * largest(force)) << label(body, damping, state.name);
        }
      }
    }
  }
}

/// The torque about the origin that damping exerts, as a share of the sum of |x| |f|.
double torque_share(const Body& body, const Damping& damping, const NodalValues& x) {
  const auto block = make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, damping);
  forces(*block, x);
  const NodalValues force = damping_product(*block, random_velocities(body.rest.size()));
  Vec3d torque{};
  double scale = 0;
  for (std::size_t node = 0; node < body.rest.size(); ++node) {
    torque += cross(at_node(x, node), at_node(force, node));
    scale += norm(at_node(x, node)) * norm(at_node(force, node));
  }
  return norm(torque) / scale;
}

/// Stretches above blend_end: nothing of `rotated` is left, nor of its torque.
TEST(Damping, BlendedConservesAngularMomentumAtModerateDeformation) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const Mat3d turn = rotation(2);
    const auto stretched = [&](double least) {
      return deformed(body, [&](const Vec3d& p) { return turn * Vec3d{1.5 * p[0], p[1], least * p[2]}; });
    };
    const auto moderate = stretched(blend_end * (1 + 1e-12)), flat = stretched(0.2);
    EXPECT_LE(torque_share(body, blended_damping, moderate), 1e-14) << evert::name_of(type);
    EXPECT_GE(torque_share(body, rotated_damping, moderate), 1e-4) << evert::name_of(type);
    EXPECT_GE(torque_share(body, blended_damping, flat), 1e-4) << evert::name_of(type);
    EXPECT_LE(torque_share(body, objective_damping, flat), 1e-14) << evert::name_of(type);
  }
}

/// C along a path through flat into the inverted has no kink: its second differences are of the second order.
TEST(Damping, BlendedIsSmoothOnTheWayThroughFlat) {
  const Body body = small_body(CellType::tet4);
  const auto block =
      make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, blended_damping);
  const auto at = [&](double least, double middle) {
    forces(*block, deformed(body, [&](const Vec3d& p) {
      return Vec3d{1.5 * p[0], middle * p[1], least * p[2]};
    }));
    return damping_product(*block, random_velocities(body.rest.size()));
  };
  const auto second_difference = [&](double least, double h, bool equal) {
    const auto of = [&](double s) { return at(s, equal ? s : 1.1); };
    const auto before = of(least - h), here = of(least), after = of(least + h);
    double most = 0;
    for (std::size_t i = 0; i + 1 < here.size(); ++i)
      most = std::max(most, std::abs(before[i] - 2 * here[i] + after[i]));
    return most;
  };
  for (const bool equal : {false, true}) {  // the two smaller stretches
    for (int i = 0; i <= 24; ++i) {
      const double least = (equal ? 0.05 : -0.6) + 0.05 * i;
      // A kink would make it half of the larger, not a quarter.
      EXPECT_LE(second_difference(least, 1e-4, equal), 0.3 * second_difference(least, 2e-4, equal) + 1e-9)
          << least;
    }
  }
}

TEST(Damping, BlendedIsRotatedWhenFlatOrInverted) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const NodalValues v = random_velocities(body.rest.size());
    for (const double least : {blend_begin, 0.0, -1.2}) {
      const auto x = deformed(body, [&](const Vec3d& p) { return Vec3d{1.5 * p[0], p[1], least * p[2]}; });
      NodalValues products[2];
      for (const auto& damping : {rotated_damping, blended_damping}) {
        const auto block =
            make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, damping);
        forces(*block, x);
        products[damping.model == DampingModel::rotated ? 0 : 1] = damping_product(*block, v);
      }
      EXPECT_LE(largest_difference(products[0], products[1]), 1e-13 * largest(products[0])) << least;
    }
  }
}

TEST(Damping, ObjectiveVanishesWhenFlat) {
  const Body body = small_body(CellType::tet4);
  const auto block =
      make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, objective_damping);
  forces(*block, deformed(body, [](const Vec3d&) { return Vec3d{}; }));
  EXPECT_EQ(largest(damping_product(*block, random_velocities(body.rest.size()))), 0);
}

TEST(Damping, PacksAgreeWithScalars) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const NodalValues v = random_velocities(body.rest.size());
    for (const Damping& damping : all_models) {
      const auto scalar = scalar_block(body, NeoHookean{.lame = soft}, damping);
      for (const auto& level : supported_levels()) {
        const auto block = level_block(level, body, NeoHookean{.lame = soft}, damping, 5);
        for (const State& state : awkward_states(body)) {
          if (!state.unique) continue;
          forces(*scalar, state.x);
          forces(*block, state.x);
          const NodalValues expected = damping_product(*scalar, v, 0.5);
          EXPECT_LE(largest_difference(damping_product(*block, v, 0.5), expected), 2e-14 * largest(expected))
              << label(body, damping, state.name) << ", " << level.name;
        }
      }
    }
  }
}

TEST(Damping, NoneCostsAndDoesNothing) {
  const Body body = small_body(CellType::tet4);
  const auto without =
      make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, no_damping);
  const auto with =
      make_elastic_block(body.elastic_cells(), body.rest, NeoHookean{.lame = soft}, rotated_damping);
  EXPECT_FALSE(without->damped());
  EXPECT_TRUE(with->damped());
  EXPECT_EQ(largest(damping_product(*without, random_velocities(body.rest.size()))), 0);
  EXPECT_EQ(with->memory() - without->memory(), body.nodes.size() / 4 * 9 * sizeof(double));
}

}  // namespace
}  // namespace evert::test
