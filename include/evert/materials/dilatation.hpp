#pragma once
#include "evert/math/vec3.hpp"

#include <concepts>

namespace evert {

/// What a model's resistance to changes of volume is made of: ψ contains λ/2 g², and P̂ λ g ∂g/∂σ.
template <class T>
struct Dilatation {
  T value;        ///< g
  Vec3<T> slope;  ///< ∂g/∂σ
};

/// Models with such a part: its mean over a cell can stand in its place, which frees fully integrated cells
/// of volumetric locking.  docs/elements.md
template <class Model>
concept HasDilatation = requires(const Model& model, const Vec3d& sigma) {
  { model.dilatation(sigma) } -> std::same_as<Dilatation<double>>;
};

}  // namespace evert
