#pragma once

namespace evert {

/// What is done about the softness of filtered elements.  PHYSICS 9
enum class FilterConstraints {
  none,       ///< nothing: they are softer than their material
  compliant,  ///< they keep all of their forces; what the filter would take off is taken implicitly
};

}  // namespace evert
