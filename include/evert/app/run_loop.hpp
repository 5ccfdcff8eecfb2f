#pragma once
#include "evert/app/observer.hpp"

#include <memory>
#include <span>

namespace evert {

/// Why a run ended.
enum class RunEnd { reached_end_time, interrupted };

/// Catches SIGINT and SIGTERM from now on; the loop then ends after the step that is being made, or the next.
void catch_signals();

/// Collective. Steps to `end_time` [s], hitting exactly every time that an observer or an event asks for, and
/// lets the observers look after each step.
RunEnd run_loop(Simulation& simulation, double end_time,
                std::span<const std::unique_ptr<Observer>> observers);

}  // namespace evert
