#pragma once
#include "evert/mesh/distributed_mesh.hpp"

/// What the kernels are measured on.
namespace evert::bench {

/// A box of cells of one type with jittered rest nodes, twisted, stretched and shaken so that about a
/// twelfth of the tetrahedra is inverted; fibres of its cells run to all sides. The same on any number of
/// ranks.
struct Specimen {
  /// Collective. `divisions`³ cubes of 1 m, each six tetrahedra (Kuhn) or one hexahedron.
  Specimen(MPI_Comm comm, CellType type, int divisions);
  Specimen(const Specimen&) = delete;  // others refer to the mesh
  Specimen& operator=(const Specimen&) = delete;

  DistributedMesh mesh;
  NodeField positions;   ///< [m]
  NodeField velocities;  ///< [m/s] normally distributed
};

}  // namespace evert::bench
