#include "extremes_report.hpp"

#include "evert/core/formatted.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

namespace evert {
namespace {

struct Totals {
  std::array<int, 4> of_grade{};  // in the order of Grade
  int promised = 0, kept = 0, let_through = 0;
  int over_limit = 0, caught = 0, caught_in_time = 0, step_works = 0;
  std::int64_t latest = 0;  // steps to the last detection
  double seconds = 0;
};

Totals totals_of(const std::vector<TriedCase>& all) {
  Totals totals;
  for (const auto& [extreme, trial] : all) {
    ++totals.of_grade[static_cast<std::size_t>(trial.grade)];
    if (extreme.promise != Promise::any) {
      ++totals.promised;
      totals.kept += trial.kept ? 1 : 0;
    }
    totals.let_through += trial.let_through ? 1 : 0;
    totals.seconds += trial.seconds;
    if (extreme.step_over_limit.value_or(0) <= 1) continue;
    ++totals.over_limit;
    if (!trial.suggested) continue;
    ++totals.caught;
    totals.caught_in_time += trial.let_through ? 0 : 1;
    totals.step_works += trial.suggestion_works ? 1 : 0;
    totals.latest = std::max(totals.latest, trial.steps);
  }
  return totals;
}

double percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

const char* promised(Promise promise) {
  switch (promise) {
    case Promise::recovery:
      return "must recover";
    case Promise::stability:
      return "must be stable";
    case Promise::detection:
      return "must be detected";
    case Promise::any:
      break;
  }
  return "";
}

/// Messages that differ in numbers and names alone are the same.
std::string kind_of(const std::string& message) {
  std::string kind;
  bool quoted = false;
  for (const char c : message) {
    if (c == '\'') quoted = !quoted;
    if (!quoted && std::isdigit(static_cast<unsigned char>(c)) == 0 &&
        std::string(".-+e").find(c) == std::string::npos)
      kind += c;
  }
  return kind;
}

/// The notes below the tables: one for each kind of message, the first of them as the example.
class Footnotes {
 public:
  /// Its number, from 1.
  std::size_t number_of(const std::string& message) {
    const auto [found, is_new] = numbers_.try_emplace(kind_of(message), messages_.size() + 1);
    if (is_new) messages_.push_back(message);
    return found->second;
  }
  void write(std::ostream& out) const {
    for (std::size_t i = 0; i < messages_.size(); ++i) out << i + 1 << ". " << messages_[i] << '\n';
    if (!messages_.empty()) out << '\n';
  }

 private:
  std::map<std::string, std::size_t> numbers_;
  std::vector<std::string> messages_;
};

std::string cell_of(const TriedCase& tried, Footnotes& notes) {
  const auto& [extreme, trial] = tried;
  std::string text = name_of(trial.grade);
  if (extreme.step_over_limit && trial.suggested)
    text = formatted("detected, %lld", static_cast<long long>(trial.steps));
  else if (trial.grade == Grade::failed || trial.grade == Grade::defect)
    text += formatted(" (%zu)", notes.number_of(trial.note));
  return trial.kept ? text : "**" + text + "**";
}

std::vector<std::string> distinct(const std::vector<const TriedCase*>& cases,
                                  std::string ExtremeCase::*what) {
  std::vector<std::string> names;
  for (const auto* one : cases)
    if (std::ranges::find(names, one->extreme.*what) == names.end()) names.push_back(one->extreme.*what);
  return names;
}

void write_table(const std::string& family, const std::vector<const TriedCase*>& cases, std::ostream& out) {
  const auto columns = distinct(cases, &ExtremeCase::column);
  Footnotes notes;
  out << "## " << static_cast<char>(std::toupper(static_cast<unsigned char>(family[0]))) << family.substr(1)
      << "\n\n| |";
  for (const auto& column : columns) out << ' ' << column << " |";
  out << "\n|---|";
  for (std::size_t i = 0; i < columns.size(); ++i) out << "---|";
  out << '\n';
  for (const auto& row : distinct(cases, &ExtremeCase::row)) {
    out << "| " << row << " |";
    for (const auto& column : columns) {
      const auto found = std::ranges::find_if(
          cases, [&](const auto* one) { return one->extreme.row == row && one->extreme.column == column; });
      out << ' ' << (found == cases.end() ? "" : cell_of(**found, notes)) << " |";
    }
    out << '\n';
  }
  out << '\n';
  notes.write(out);
}

}  // namespace

void write_line(const TriedCase& tried, std::ostream& out) {
  const auto& [extreme, trial] = tried;
  out << formatted("%-9s %8lld steps %6.2f s  ", name_of(trial.grade), static_cast<long long>(trial.steps),
                   trial.seconds)
      << extreme.name() << '\n';
  if (!trial.kept)
    out << "          PROMISE NOT KEPT, " << promised(extreme.promise) << ": " << trial.note << '\n';
  out.flush();
}

void write_totals(const std::vector<TriedCase>& all, std::ostream& out) {
  const auto totals = totals_of(all);
  const auto count = static_cast<int>(all.size());
  out << formatted("%d cases: %d recovered, %d stable, %d failed with a message, %d defects\n", count,
                   totals.of_grade[0], totals.of_grade[1], totals.of_grade[2], totals.of_grade[3]);
  out << formatted("promises: %d of %d cases kept theirs; %d have none but to end in one of these\n",
                   totals.kept, totals.promised, count - totals.promised);
  out << formatted("not finite: in %d cases something would have been written that is not\n",
                   totals.let_through);
  if (totals.over_limit == 0) return;
  out << formatted(
      "steps over the limit: %d of %d caught (%.1f %%), %d before anything was not finite (%.1f %%); the "
      "last one after %lld steps; the recommended step is stable in %d\n",
      totals.caught, totals.over_limit, percent(totals.caught, totals.over_limit), totals.caught_in_time,
      percent(totals.caught_in_time, totals.over_limit), static_cast<long long>(totals.latest),
      totals.step_works);
}

void write_document(const std::vector<TriedCase>& all, const std::string& command, std::ostream& out) {
  out << "# What holds at the extremes\n\n"
         "Made by\n\n```sh\n"
      << command
      << "\n```\n\n"
         "which ends with\n\n```\n";
  write_totals(all, out);
  out << "```\n\n"
         "Every case ends in one of three grades, or is a defect:\n\n"
         "- *recovered*: at its rest shape to 1e-6 of its size (RMS), with nothing inverted;\n"
         "- *stable*: came to its end, with its energy bounded: never gained more than the scheme makes it "
         "ripple (of a "
         "step at the share s of the limit, s² of the largest, 2s/(1 + s) with symplectic Euler);\n"
         "- *failed*: stopped with a message that says what is wrong; the number is that of an example below "
         "the table;\n"
         "- *detected, n*: stopped as unstable after n steps, and stable with the step that the message "
         "recommends.\n\n"
         "Bold is what did not do what it must. `evert extremes NAME` runs the cases with NAME in their "
         "names, "
         "`evert extremes NAME -write DIR` writes the scene of one, for `evert run`.\n\n";
  std::vector<std::string> families;
  std::map<std::string, std::vector<const TriedCase*>> of_family;
  for (const auto& one : all) {
    auto& cases = of_family[one.extreme.family];
    if (cases.empty()) families.push_back(one.extreme.family);
    cases.push_back(&one);
  }
  for (const auto& family : families) write_table(family, of_family[family], out);
}

}  // namespace evert
