#pragma once
#include "evert/mesh/distributed_mesh.hpp"

#include <functional>

namespace evert {

/// A force per rest volume [N/m^3] at a rest position [m] and a time [s].
using BodyForce = std::function<Vec3d(const Vec3d& rest_position, double time)>;

/// Not collective. Adds to `f`, on owned nodes and ghosts, what the cells of this rank get of `force`: ∫ N_a
/// b dX by the quadrature of each element. Ghosts are still to be summed.
void add_body_force(const DistributedMesh& mesh, const BodyForce& force, double time, NodeField& f);

}  // namespace evert
