#pragma once
#include "evert/core/petsc.hpp"

#include <cstddef>
#include <span>

namespace evert {

/// Owned values of a Vec, for the life of the object.
class VecView {
 public:
  explicit VecView(Vec vec) : vec_(vec) {
    PetscInt size = 0;
    check(VecGetLocalSize(vec, &size));
    check(VecGetArray(vec, &data_));
    size_ = static_cast<std::size_t>(size);
  }
  ~VecView() { static_cast<void>(VecRestoreArray(vec_, &data_)); }
  VecView(const VecView&) = delete;
  VecView& operator=(const VecView&) = delete;
  [[nodiscard]] std::span<double> values() const { return {data_, size_}; }

 private:
  Vec vec_;
  PetscScalar* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace evert
