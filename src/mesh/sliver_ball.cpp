#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/positive.hpp"
#include "evert/mesh/bad_meshes.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/shapes/solids.hpp"

#include "slivers.hpp"
#include <cmath>

namespace evert {
namespace {

// Thicker ones are no worse than what the lattice has at the surface.
constexpr double thickest = 0.1;

void require_between(double value, double high, const char* name) {
  if (!(value >= 0 && value <= high))
    throw UserError(formatted("%s is %g, but must be from 0 to %g", name, value, high));
}

}  // namespace

Mesh generate_sliver_ball(const SliverBall& ball) {
  require_between(ball.slivers, 0.05, "slivers");
  require_between(ball.jitter, 0.3, "jitter");
  require_between(ball.thinnest, thickest, "thinnest");
  auto mesh = generate(Sphere(ball.radius), "ball", ball.edge_length);
  RandomNumbers random(ball.seed);
  shake_inner_nodes(mesh, ball.jitter * ball.edge_length, random);
  // Each sliver is a cell more.
  const auto wanted = static_cast<GlobalIndex>(
      std::llround(ball.slivers / (1 - ball.slivers) * static_cast<double>(mesh.cell_count())));
  const auto made = insert_slivers(mesh, wanted, {ball.thinnest, thickest}, random);
  if (made < wanted)
    throw UserError(
        formatted("slivers are %g of all, but of the %lld that makes only %lld have room: fewer slivers, "
                  "more jitter, a smaller thinnest or a smaller edge_length are needed",
                  ball.slivers, static_cast<long long>(wanted), static_cast<long long>(made)));
  return mesh;
}

}  // namespace evert
