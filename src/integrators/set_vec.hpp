#pragma once
#include "evert/core/log.hpp"
#include "evert/core/petsc.hpp"

#include <cstddef>

namespace evert {

/// Every owned component of `vec` becomes value(index, component).
template <class Value>
void set_vec(Vec vec, Value&& value) {
  PetscScalar* values = nullptr;
  PetscInt size = 0;
  check(VecGetLocalSize(vec, &size));
  check(VecGetArray(vec, &values));
  {
    const PhaseScope scope(Phase::vector_update, 3.0 * size);
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) values[i] = value(i, values[i]);
  }
  check(VecRestoreArray(vec, &values));
}

}  // namespace evert
