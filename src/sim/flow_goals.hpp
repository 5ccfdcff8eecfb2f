#pragma once
#include "evert/forces/elastic_forces.hpp"
#include "evert/mesh/distributed_mesh.hpp"
#include "evert/sim/definition.hpp"

namespace evert {

/// Collective. Leads the flow of a region to `goal`. Throws UserError on all ranks, with some of the cells,
/// where it is none that can be reached. `mesh` outlives `elastic`.
void set_goal(ElasticForces& elastic, const DistributedMesh& mesh, const FlowGoal& goal);

}  // namespace evert
