#include "gmsh_file.hpp"
#include <algorithm>
#include <string>

/// Values of elements, the same in Gmsh's two formats; tags and counts are text in binary files too.
namespace evert {
namespace {

/// What stands in front of the values.
struct Heading {
  std::string name;
  std::int64_t step = 0;
  GlobalIndex components = 0;
  GlobalIndex values = 0;
};

Heading read_heading(InputCursor& in) {
  Heading heading;
  const auto strings = in.count("the number of string tags", 2);
  in.rest_of_line();
  for (GlobalIndex i = 0; i < strings; ++i) {
    auto text = in.rest_of_line();
    if (text.size() < 2 || text.front() != '"' || text.back() != '"')
      in.fail("a string tag must stand in double quotes");
    if (i == 0) heading.name = text.substr(1, text.size() - 2);
  }
  const auto reals = in.count("the number of real tags", 2);
  for (GlobalIndex i = 0; i < reals; ++i) static_cast<void>(in.word("a real tag"));
  const auto integers = in.count("the number of integer tags", 2);
  if (integers < 3) in.fail("element data must have 3 integer tags at least: step, components, elements");
  heading.step = in.integer("the time step of element data");
  heading.components = in.count("the number of components of element data", 1);
  heading.values = in.count("the number of elements that have data", 4);
  for (GlobalIndex i = 3; i < integers; ++i) static_cast<void>(in.integer("an integer tag"));
  in.rest_of_line();  // binary values begin behind it
  return heading;
}

}  // namespace

bool read_gmsh_element_data(GmshFile& file) {
  if (!file.vectors.wanted()) return false;
  const bool seen = file.vectors.found();
  const auto heading = read_heading(file.in);
  if (!file.vectors.meet(heading.name, heading.components, file.in) || seen) return false;
  for (GlobalIndex i = 0; i < heading.values; ++i) {
    const auto tag = file.integer("the number of an element");
    Vec3d vector{};
    for (auto& component : vector.components) component = file.real("a component of a vector");
    file.set_vector(tag, vector);
  }
  return true;
}

}  // namespace evert
