#include "digest.hpp"

#include <bit>

namespace evert {
namespace {

/// Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators": the output function of
/// splitmix64.
std::uint64_t mix(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15U;
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  return bits ^ (bits >> 31U);
}

std::uint64_t term(std::int64_t number, std::uint64_t bits) {
  return mix(bits ^ mix(static_cast<std::uint64_t>(number)));
}

std::uint64_t sum_over_ranks(MPI_Comm comm, std::uint64_t sum) {
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, comm);
  return sum;
}

}  // namespace

std::uint64_t digest(MPI_Comm comm, std::int64_t first, std::span<const double> values) {
  std::uint64_t sum = 0;
  for (const auto value : values) sum += term(first++, std::bit_cast<std::uint64_t>(value));
  return sum_over_ranks(comm, sum);
}

std::uint64_t digest(const DistributedMesh& mesh) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < mesh.natural_nodes.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      sum += term(3 * mesh.natural_nodes[i] + static_cast<std::int64_t>(c),
                  std::bit_cast<std::uint64_t>(mesh.rest_positions[i][c]));
  for (const auto& list : mesh.cells) {
    const auto width = static_cast<std::size_t>(node_count(list.type));
    for (std::size_t i = 0; i < list.nodes.size(); ++i) {
      const auto node = mesh.original_nodes[static_cast<std::size_t>(list.nodes[i])];
      // Negative numbers: apart from those of the positions.
      sum += term(-1 - 16 * list.global_ids[i / width] - static_cast<std::int64_t>(i % width),
                  static_cast<std::uint64_t>(node));
    }
  }
  return sum_over_ranks(mesh.comm, sum);
}

}  // namespace evert
