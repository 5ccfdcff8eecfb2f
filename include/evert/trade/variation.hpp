#pragma once
#include "evert/scene/source.hpp"

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

/// The settings of a scene that a sweep goes through: axes, their values, the grid of all combinations, and
/// the finer ones that serve as a reference.
namespace evert::trade {

/// "key=value,value" as on the command line. A key may have `*` in place of the name of a body or obstacle; a
/// value may be a multiple of what the scene has: x0.5.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

/// Commas inside of [] and {} separate nothing. Throws UserError for what is no key=value,...
[[nodiscard]] Variation parse_variation(const std::string& text);

/// How a value is made better, and so how the reference differs from the settings.
enum class AxisKind {
  step,       ///< smaller is better, by the ratio of a refinement
  length,     ///< of edges of a mesh: the same
  count,      ///< of cells: more is better, by the ratio
  tolerance,  ///< smaller is better, ten times at each refinement
  choice      ///< there is a best one, and nothing finer
};

using Overrides = std::vector<std::string>;  ///< "path=value"

/// A variation with what its values mean for a scene.
struct Axis {
  std::string key;
  AxisKind kind = AxisKind::choice;
  std::vector<std::string> values;   ///< as given
  std::vector<double> numbers;       ///< the value, a multiple of the scene's one, or the number of cells
  std::vector<Overrides> overrides;  ///< per value
  std::size_t best = 0;              ///< which value a reference has

  [[nodiscard]] std::size_t size() const { return values.size(); }
  /// Other than of a choice the values have an order: whether value i is cheaper and less accurate than j.
  [[nodiscard]] bool is_coarser(std::size_t i, std::size_t j) const;
};

/// What multiples refer to where the scene says nothing, or `auto`: by path.
using Automatic = std::map<std::string, double>;

/// Throws UserError for an unknown key, for values that the scene may not have, for a `*` that nothing fits.
/// Bodies that have no such key keep what they have.
[[nodiscard]] Axis resolve(const SceneSource& scene, const Variation& variation, const Automatic& automatic);

/// One value of each axis.
using Choice = std::vector<std::size_t>;

/// All combinations, the last axis fastest. Throws UserError for more than 10000.
[[nodiscard]] std::vector<Choice> grid_of(std::span<const Axis> axes);
[[nodiscard]] Overrides overrides_of(std::span<const Axis> axes, const Choice& choice);
/// "time_step 1e-4, cell hex8".
[[nodiscard]] std::string label_of(std::span<const Axis> axes, const Choice& choice);

/// Overrides of the reference: the best values, refined `times` times by `ratio`; then `more`.
[[nodiscard]] Overrides reference_of(const SceneSource& scene, std::span<const Axis> axes,
                                     const Automatic& automatic, int times, double ratio,
                                     const Overrides& more);
/// 2 where cells are counted, √2 where edges have a length, else 2.
[[nodiscard]] double refinement_ratio(std::span<const Axis> axes);

}  // namespace evert::trade
