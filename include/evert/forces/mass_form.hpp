#pragma once

namespace evert {

/// How the mass of a cell acts on its nodes.
enum class MassForm {
  lumped,      ///< a positive mass at each node: M is diagonal
  consistent,  ///< ∫ρ N_a N_b dX: accelerations have the order of the element
};

}  // namespace evert
