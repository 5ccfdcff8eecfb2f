#pragma once
#include "evert/mesh/distributed_mesh.hpp"

#include <cstdint>
#include <span>

/// 64-bit digests that do not depend on how values are spread over ranks: sums of a hash of each value and
/// its number.
namespace evert {

/// Collective. Of an array of which this rank holds the values from number `first` on.
[[nodiscard]] std::uint64_t digest(MPI_Comm comm, std::int64_t first, std::span<const double> values);

/// Collective. Of the rest positions and the cells, as they are in the undistributed mesh.
[[nodiscard]] std::uint64_t digest(const DistributedMesh& mesh);

}  // namespace evert
