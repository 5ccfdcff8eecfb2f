#pragma once
#include "material_paths.hpp"
#include <string>
#include <vector>

namespace evert {

/// One panel of the plot.
struct PlottedMaterial {
  std::string title;
  PointMaterial point;
};

/// An SVG page: stress over stretch of each material along every path from `from` to `to`, one panel each.
/// paper A, Fig. 4
[[nodiscard]] std::string stress_plot(const std::vector<PlottedMaterial>& materials, double from, double to);

}  // namespace evert
