#pragma once
#include "evert/math/vec3.hpp"

#include <span>
#include <vector>

/// The small problems of a node that is inside one or several bodies. None depends on the order of the bodies
/// by more than rounding.  docs/design/contact.md
namespace evert {

/// A bound n · d ≥ least on a change d of a position or a velocity.
struct Bound {
  Vec3d normal;      ///< unit
  double least = 0;  ///< [m] or [m/s]
};

/// The smallest change that obeys all bounds. Where none does, as for a node pinched between bodies, the one
/// that violates them least in the sense of squares.
struct PushOut {
  Vec3d change{};
  bool pinched = false;
};
[[nodiscard]] PushOut push_out(std::span<const Bound> bounds);

/// The projector off the normals of all bounds.
[[nodiscard]] Mat3d tangent_of(std::span<const Bound> bounds);

/// The shares s of a vector in the span of the normals: vector = Σ s_k n_k, with the smallest Σ s_k² where
/// that is not unique. `tangent` is the projector off all normals.
void split_over(std::span<const Bound> bounds, const Mat3d& tangent, const Vec3d& vector,
                std::vector<double>& shares);

}  // namespace evert
