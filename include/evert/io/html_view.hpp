#pragma once
#include "evert/io/run_reader.hpp"

#include <cstddef>
#include <string>

namespace evert {

struct HtmlViewOptions {
  std::string title{};
  std::size_t max_frames = 240;         ///< ≥ 1; evenly spaced, with the first and the last
  std::size_t max_triangles = 100'000;  ///< ≥ 1; larger surfaces are simplified
  std::size_t max_bytes = 30'000'000;   ///< of the page: fewer frames are shown where it would be larger
  std::size_t up = 1;                   ///< axis that points up: 0, 1 or 2
};

/// A web page and what it shows of a run.
struct HtmlView {
  std::string page;
  std::size_t frames = 0;
  std::size_t triangles = 0;
  std::size_t surface_triangles = 0;  ///< before simplification
  bool cut_to_size = false;           ///< fewer frames than max_frames because of max_bytes
};

/// One self-contained page that plays the run: the surface of the mesh, coloured by the smallest stretch of
/// the cells at each vertex (or by the inversion flag, or not at all, as the frames have it). Positions are
/// rounded to 16 bits within the bounding box of what is shown. Throws UserError when the file lacks frames,
/// cells or finite positions, or is damaged.
[[nodiscard]] HtmlView html_view(const RunReader& run, const HtmlViewOptions& options);

}  // namespace evert
