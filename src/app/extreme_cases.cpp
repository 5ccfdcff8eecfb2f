#include "evert/app/extreme_case.hpp"

#include "extreme_scenes.hpp"
#include <algorithm>

namespace evert {

std::string ExtremeCase::name() const {
  auto text = family + "/" + row + "/" + column;
  std::ranges::replace(text, ' ', '_');
  std::erase(text, ',');
  return text;
}

std::vector<ExtremeCase> extreme_cases(int ranks) {
  std::vector<ExtremeCase> cases;
  extremes::add_starts(cases, ranks);
  extremes::add_numbers(cases);
  extremes::add_steps(cases);
  extremes::add_products(cases);
  return cases;
}

}  // namespace evert
