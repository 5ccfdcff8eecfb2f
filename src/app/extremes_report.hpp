#pragma once
#include "evert/app/extreme_trial.hpp"

#include <ostream>
#include <string>
#include <vector>

/// How `evert extremes` says what it found.
namespace evert {

struct TriedCase {
  ExtremeCase extreme;
  Trial trial;
};

/// One line, with the message below where the promise is not kept.
void write_line(const TriedCase& tried, std::ostream& out);

/// Numbers of cases by grade, of promises kept, and of instabilities caught.
void write_totals(const std::vector<TriedCase>& all, std::ostream& out);

/// docs/extremes.md: a table a family. `command` is how it was made.
void write_document(const std::vector<TriedCase>& all, const std::string& command, std::ostream& out);

}  // namespace evert
