#pragma once

/// What can be chosen about the way that time advances, as plain values.
namespace evert {

enum class IntegrationMethod { newmark, verlet, symplectic_euler, explicit_euler, quasistatic };

/// Which tangent the Newton steps of `quasistatic` are made with.
enum class TangentChoice {
  adaptive,   ///< projected until full steps halve the residual, from there on the full one
  projected,  ///< the nearest positive semidefinite one of every point
  full,       ///< ∂P/∂F as it is
};

struct QuasistaticOptions {
  int load_steps = 1;  ///< parts that a change of load or position is applied in, at first
  TangentChoice tangent = TangentChoice::adaptive;
  int untangle = 10;  ///< fruitless attempts in a row to find a state of less energy where cells are inverted
};

}  // namespace evert
