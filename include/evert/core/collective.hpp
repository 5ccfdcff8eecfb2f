#pragma once
#include "evert/core/error.hpp"

#include <mpi.h>

#include <exception>
#include <string>

/// Errors that happen on some ranks become errors on all of them, so that no rank waits for one that gave up.
namespace evert {

[[nodiscard]] int rank_of(MPI_Comm comm);
[[nodiscard]] int size_of(MPI_Comm comm);

/// Collective. Throws UserError with the message of the lowest rank whose `message` is not empty; returns
/// when all are empty.
void agree_or_throw(MPI_Comm comm, const std::string& message);

/// Collective. Runs `work` on rank 0 only; a UserError there is thrown on every rank.
template <class Work>
void on_root(MPI_Comm comm, Work&& work) {
  std::string message;
  if (rank_of(comm) == 0) {
    try {
      work();
    } catch (const UserError& error) {
      message = error.what();
    }
  }
  agree_or_throw(comm, message);
}

/// Collective. Runs `work` on every rank; a UserError on any is thrown on all.
template <class Work>
void on_every_rank(MPI_Comm comm, Work&& work) {
  std::string message;
  try {
    work();
  } catch (const UserError& error) {
    message = error.what();
  }
  agree_or_throw(comm, message);
}

}  // namespace evert
