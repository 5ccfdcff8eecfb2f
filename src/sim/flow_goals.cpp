#include "flow_goals.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace evert {

void set_goal(ElasticForces& elastic, const DistributedMesh& mesh, const FlowGoal& goal) {
  constexpr std::size_t shown = 8;
  constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();
  MPI_Comm comm = mesh.comm;
  auto refused = elastic.set_goal(
      goal.region, goal.control,
      [&mesh, position = goal.position](std::size_t entry, LocalIndex cell, std::size_t node) {
        return position(mesh, entry, cell, node);
      });
  auto count = static_cast<GlobalIndex>(refused.size());
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, comm);
  if (count == 0) return;
  std::ranges::sort(refused);
  refused.resize(shown, none);
  std::vector<GlobalIndex> all(shown * static_cast<std::size_t>(size_of(comm)));
  MPI_Allgather(refused.data(), shown, MPI_INT64_T, all.data(), shown, MPI_INT64_T, comm);
  std::ranges::sort(all);
  std::string numbers;
  for (std::size_t i = 0; i < shown && all[i] != none; ++i)
    numbers += (i > 0 ? ", " : " ") + std::to_string(all[i]);
  throw UserError(goal.name + ": " + std::to_string(count) +
                  " elements would be turned inside out or flat, " +
                  formatted("or stretched or compressed more than %g times, the 'limit' of the plasticity; ",
                            elastic.properties(goal.region).plasticity->limit) +
                  "the first are" + numbers);
}

}  // namespace evert
