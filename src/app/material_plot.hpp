#pragma once
#include "evert/materials/material.hpp"

#include <string>
#include <vector>

namespace evert {

/// One panel of the plot.
struct PlottedMaterial {
  std::string title;
  Material material;
};

/// An SVG page: stress over stretch of each material along every path from `from` to `to`, one panel each.
/// paper A, Fig. 4
[[nodiscard]] std::string stress_plot(const std::vector<PlottedMaterial>& materials, double from, double to);

}  // namespace evert
