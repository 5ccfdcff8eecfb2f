#pragma once

namespace evert {

/// What is done about the softness of filtered elements.  PHYSICS 9
enum class FilterConstraints {
  none,       ///< nothing: they are softer than their material
  paper,      ///< short edges and heights keep their lengths.  paper B, section 5
  compliant,  ///< they keep all of their forces; what the filter would take off is taken implicitly
};
[[nodiscard]] constexpr const char* name_of(FilterConstraints constraints) {
  return constraints == FilterConstraints::none    ? "none"
         : constraints == FilterConstraints::paper ? "paper"
                                                   : "compliant";
}

/// How the lengths of `paper` are kept.
enum class FilterProjection {
  shake,       ///< along the gradients at the beginning of the step: angular momentum is kept
  goldenthal,  ///< along those of every iterate
};

}  // namespace evert
