#pragma once
#include "evert/core/index.hpp"

#include <string>
#include <vector>

namespace evert {

/// What one step did.
struct StepReport {
  double dt = 0;                     ///< [s]
  int cg_iterations = 0;             ///< over the damping solves of the step
  LocalIndex contacts = 0;           ///< colliding owned nodes on this rank
  bool stop_requested = false;       ///< some rank wants the run to end here
  int newton_iterations = 0;         ///< over the load steps of a quasistatic step
  int linear_iterations = 0;         ///< of the linear solves in those
  int projection_iterations = 0;     ///< to keep the lengths of filtered elements
  std::vector<std::string> notes{};  ///< what a user should know, one sentence each; the same on every rank
};

}  // namespace evert
