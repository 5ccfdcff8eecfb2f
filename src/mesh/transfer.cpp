#include "transfer.hpp"

#include <algorithm>

namespace evert {
namespace {
constexpr int tag = 0;
}

void send_bytes(MPI_Comm comm, int to, const void* data, std::size_t bytes, std::size_t piece) {
  const auto* at = static_cast<const std::byte*>(data);
  for (std::size_t sent = 0; sent < bytes; sent += piece)
    MPI_Send(at + sent, static_cast<int>(std::min(piece, bytes - sent)), MPI_BYTE, to, tag, comm);
}

void receive_bytes(MPI_Comm comm, int from, void* data, std::size_t bytes, std::size_t piece) {
  auto* at = static_cast<std::byte*>(data);
  for (std::size_t got = 0; got < bytes; got += piece)
    MPI_Recv(at + got, static_cast<int>(std::min(piece, bytes - got)), MPI_BYTE, from, tag, comm,
             MPI_STATUS_IGNORE);
}

void broadcast(MPI_Comm comm, std::vector<std::string>& strings) {
  auto count = static_cast<int>(strings.size());
  MPI_Bcast(&count, 1, MPI_INT, 0, comm);
  strings.resize(static_cast<std::size_t>(count));
  for (auto& string : strings) {
    auto length = static_cast<int>(string.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, comm);
    string.resize(static_cast<std::size_t>(length));
    MPI_Bcast(string.data(), length, MPI_CHAR, 0, comm);
  }
}

}  // namespace evert
