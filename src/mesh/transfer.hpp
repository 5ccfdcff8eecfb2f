#pragma once
#include <mpi.h>

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

/// Arrays of any size between ranks: MPI counts are int, so long arrays travel in pieces.
namespace evert {

inline constexpr std::size_t transfer_piece = std::size_t{1} << 30;  ///< bytes of one message

void send_bytes(MPI_Comm comm, int to, const void* data, std::size_t bytes,
                std::size_t piece = transfer_piece);
void receive_bytes(MPI_Comm comm, int from, void* data, std::size_t bytes,
                   std::size_t piece = transfer_piece);

template <class T>
void send(MPI_Comm comm, int to, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t size = values.size();
  send_bytes(comm, to, &size, sizeof size);
  send_bytes(comm, to, values.data(), size * sizeof(T));
}

template <class T>
[[nodiscard]] std::vector<T> receive(MPI_Comm comm, int from) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::size_t size = 0;
  receive_bytes(comm, from, &size, sizeof size);
  std::vector<T> values(size);
  receive_bytes(comm, from, values.data(), size * sizeof(T));
  return values;
}

/// Collective: everyone gets rank 0's strings.
void broadcast(MPI_Comm comm, std::vector<std::string>& strings);

}  // namespace evert
