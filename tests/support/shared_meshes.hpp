#pragma once
#include "evert/mesh/distributed_mesh.hpp"
#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/repair.hpp"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

/// Meshes from practice, which are no part of the project: in the folder that EVERT_SHARED_MESHES names.
namespace evert::test {

/// The path of one; empty where it is not there, and the test is to be skipped.
inline std::optional<std::string> shared_mesh(const std::string& name) {
  const char* folder = std::getenv("EVERT_SHARED_MESHES");
  if (folder == nullptr) return {};
  const auto path = std::filesystem::path(folder) / name;
  if (!std::filesystem::exists(path)) return {};
  return path.string();
}

/// Collective. That mesh, all cells of positive volume, over the ranks.
inline DistributedMesh distributed(const std::string& path, MPI_Comm comm = PETSC_COMM_WORLD) {
  Mesh mesh;
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) {
    mesh = read_mesh(path);
    reorient(mesh);
  }
  return distribute(comm, mesh);
}

}  // namespace evert::test
