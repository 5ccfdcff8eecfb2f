#include "evert/io/natural_order.hpp"

namespace evert {
namespace {

using LayoutHandle = PetscHandle<PetscLayout, PetscLayoutDestroy>;

/// An MPI type for one item.
class ItemType {
 public:
  explicit ItemType(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~ItemType() { MPI_Type_free(&type_); }
  ItemType(const ItemType&) = delete;
  ItemType& operator=(const ItemType&) = delete;
  [[nodiscard]] MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

}  // namespace

NaturalOrder::NaturalOrder(MPI_Comm comm, GlobalIndex total, std::span<const GlobalIndex> numbers)
    : total_(total), item_count_(numbers.size()) {
  LayoutHandle layout;
  check(PetscLayoutCreate(comm, layout.out()));
  check(PetscLayoutSetSize(layout.get(), static_cast<PetscInt>(total)));
  check(PetscLayoutSetUp(layout.get()));
  PetscInt begin = 0;
  PetscInt end = 0;
  check(PetscLayoutGetRange(layout.get(), &begin, &end));
  first_ = begin;
  slice_size_ = static_cast<std::size_t>(end - begin);
  const std::vector<PetscInt> roots(numbers.begin(), numbers.end());
  check(PetscSFCreate(comm, plan_.out()));
  check(PetscSFSetGraphLayout(plan_.get(), layout.get(), static_cast<PetscInt>(roots.size()), nullptr,
                              PETSC_COPY_VALUES, roots.data()));
  check(PetscSFSetUp(plan_.get()));
}

void NaturalOrder::move_to_slices(const void* values, void* slice, std::size_t bytes_per_item) const {
  const ItemType item(bytes_per_item);
  check(PetscSFReduceBegin(plan_.get(), item.get(), values, slice, MPI_REPLACE));
  check(PetscSFReduceEnd(plan_.get(), item.get(), values, slice, MPI_REPLACE));
}

void NaturalOrder::move_to_owners(const void* slice, void* values, std::size_t bytes_per_item) const {
  const ItemType item(bytes_per_item);
  check(PetscSFBcastBegin(plan_.get(), item.get(), slice, values, MPI_REPLACE));
  check(PetscSFBcastEnd(plan_.get(), item.get(), slice, values, MPI_REPLACE));
}

NaturalOrder natural_node_order(const DistributedMesh& mesh) {
  return {mesh.comm, mesh.total_nodes, mesh.natural_nodes};
}

NaturalOrder natural_cell_order(const DistributedMesh& mesh) {
  std::vector<GlobalIndex> numbers;
  for (const auto& cells : mesh.cells)
    numbers.insert(numbers.end(), cells.global_ids.begin(), cells.global_ids.end());
  return {mesh.comm, mesh.total_cells, numbers};
}

}  // namespace evert
