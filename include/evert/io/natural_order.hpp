#pragma once
#include "evert/core/index.hpp"
#include "evert/core/petsc.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <petscsf.h>

#include <span>
#include <type_traits>
#include <vector>

/// The order of files: by number in the undistributed mesh, so that they do not depend on the ranks.
namespace evert {

/// Moves items (nodes or cells) between their owners and consecutive, equal slices of the natural order. An
/// immutable plan; every call is collective.
class NaturalOrder {
 public:
  /// `numbers`: the natural number of each item of this rank; those of all ranks are 0 … total − 1, once
  /// each.
  NaturalOrder(MPI_Comm comm, GlobalIndex total, std::span<const GlobalIndex> numbers);

  [[nodiscard]] GlobalIndex total() const { return total_; }
  [[nodiscard]] GlobalIndex first() const {
    return first_;
  }  ///< natural number that this rank's slice begins with
  [[nodiscard]] std::size_t slice_size() const { return slice_size_; }
  [[nodiscard]] std::size_t item_count() const { return item_count_; }  ///< of this rank

  /// `values`: `width` of them for each item of this rank. The result: as many for each item of the slice.
  template <class T>
  [[nodiscard]] std::vector<T> to_slices(std::span<const T> values, std::size_t width = 1) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> slice(slice_size_ * width);
    move_to_slices(values.data(), slice.data(), width * sizeof(T));
    return slice;
  }

  /// The way back.
  template <class T>
  [[nodiscard]] std::vector<T> to_owners(std::span<const T> slice, std::size_t width = 1) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(item_count_ * width);
    move_to_owners(slice.data(), values.data(), width * sizeof(T));
    return values;
  }

 private:
  void move_to_slices(const void* values, void* slice, std::size_t bytes_per_item) const;
  void move_to_owners(const void* slice, void* values, std::size_t bytes_per_item) const;

  PetscHandle<PetscSF, PetscSFDestroy> plan_;  // leaves: this rank's items; roots: its slice
  GlobalIndex total_;
  GlobalIndex first_ = 0;
  std::size_t slice_size_ = 0;
  std::size_t item_count_;
};

/// Collective. The order of the owned nodes.
[[nodiscard]] NaturalOrder natural_node_order(const DistributedMesh& mesh);
/// Collective. The order of the cells of all of `mesh.cells`, one list after the other.
[[nodiscard]] NaturalOrder natural_cell_order(const DistributedMesh& mesh);

}  // namespace evert
