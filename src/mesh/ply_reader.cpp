#include "surface_builder.hpp"
#include <cmath>
#include <map>
#include <vector>

namespace evert {
namespace {

enum class PlyFormat { ascii, little, big };

/// Bytes of a number, and whether it is a float; by the names that PLY has for it.
struct PlyType {
  char kind;  // i, u or f
  std::size_t size;
};

const std::map<std::string, PlyType, std::less<>>& ply_types() {
  static const std::map<std::string, PlyType, std::less<>> types{
      {"char", {'i', 1}},  {"int8", {'i', 1}},    {"uchar", {'u', 1}},  {"uint8", {'u', 1}},
      {"short", {'i', 2}}, {"int16", {'i', 2}},   {"ushort", {'u', 2}}, {"uint16", {'u', 2}},
      {"int", {'i', 4}},   {"int32", {'i', 4}},   {"uint", {'u', 4}},   {"uint32", {'u', 4}},
      {"float", {'f', 4}}, {"float32", {'f', 4}}, {"double", {'f', 8}}, {"float64", {'f', 8}}};
  return types;
}

struct PlyProperty {
  std::string name;
  PlyType type;
  bool is_list = false;
  PlyType count_type{};
};

struct PlyElement {
  std::string name;
  GlobalIndex count;
  std::vector<PlyProperty> properties;
};

class PlyReader {
 public:
  PlyReader(InputCursor& in, SurfaceBuilder& surface) : in_(in), surface_(surface) {}

  void run() {
    read_header();
    for (const auto& element : elements_) {
      for (const auto& property : element.properties)
        (void)in_.plausible_count(element.count, element.name,
                                  format_ == PlyFormat::ascii ? 2 : least(property));
      for (GlobalIndex i = 0; i < element.count; ++i) read_one(element);
    }
  }

 private:
  static std::size_t least(const PlyProperty& property) {
    return property.is_list ? property.count_type.size : property.type.size;
  }

  void read_header() {
    if (in_.word("ply") != "ply") in_.fail("must begin with 'ply'");
    while (true) {
      const auto keyword = in_.word("a line of the header, up to end_header");
      if (keyword == "end_header") break;
      if (keyword == "format")
        read_format();
      else if (keyword == "element")
        read_element();
      else if (keyword == "property")
        read_property();
      else if (keyword != "comment" && keyword != "obj_info")
        in_.fail("is no line of a header: must be format, element, property or comment");
      in_.rest_of_line();
    }
    in_.rest_of_line();
    if (!has_format_) in_.fail("the header has no format");
  }

  void read_format() {
    const auto word = in_.word("a format");
    has_format_ = true;
    if (word == "ascii")
      format_ = PlyFormat::ascii;
    else if (word == "binary_little_endian")
      format_ = PlyFormat::little;
    else if (word == "binary_big_endian")
      format_ = PlyFormat::big;
    else
      in_.fail("is no format: must be ascii, binary_little_endian or binary_big_endian");
  }

  void read_element() {
    const std::string name(in_.word("the name of an element"));
    elements_.push_back({name, in_.count("the number of elements", 1), {}});
  }

  PlyType read_type() {
    const auto found = ply_types().find(in_.word("a type"));
    if (found == ply_types().end()) in_.fail("is no type of a number, such as float or uchar");
    return found->second;
  }

  void read_property() {
    if (elements_.empty()) in_.fail("a property stands before the first element");
    PlyProperty property;
    if (in_.peek_word() == "list") {
      (void)in_.word("list");
      property.is_list = true;
      property.count_type = read_type();
    }
    property.type = read_type();
    property.name = in_.word("the name of a property");
    elements_.back().properties.push_back(property);
  }

  template <class T>
  double binary() {
    return static_cast<double>(
        in_.binary<T>("a number", (format_ == PlyFormat::big) != (std::endian::native == std::endian::big)));
  }

  double read_number(const PlyType& type) {
    if (format_ == PlyFormat::ascii) return in_.real("a number");
    if (type.kind == 'f') return type.size == 4 ? binary<float>() : binary<double>();
    const bool has_sign = type.kind == 'i';
    if (type.size == 1) return has_sign ? binary<std::int8_t>() : binary<std::uint8_t>();
    if (type.size == 2) return has_sign ? binary<std::int16_t>() : binary<std::uint16_t>();
    return has_sign ? binary<std::int32_t>() : binary<std::uint32_t>();
  }

  void read_one(const PlyElement& element) {
    Vec3d point{};
    bool is_face = false;
    corners_.clear();
    for (const auto& property : element.properties) {
      if (!property.is_list) {
        const double value = read_number(property.type);
        for (std::size_t k = 0; k < 3; ++k)
          if (property.name == std::string(1, "xyz"[k])) point[k] = value;
        continue;
      }
      const bool is_corners = property.name == "vertex_indices" || property.name == "vertex_index";
      const double written = read_number(property.count_type);
      if (!(written >= 0) || written != std::floor(written)) in_.fail("is no length of a list");
      const auto length = in_.plausible_count(static_cast<std::int64_t>(written), "list", 1);
      for (GlobalIndex i = 0; i < length; ++i) {
        const double value = read_number(property.type);
        if (is_corners) corners_.push_back(std::isfinite(value) ? static_cast<std::int64_t>(value) : -1);
      }
      is_face = is_face || is_corners;
    }
    if (element.name == "vertex") {
      if (!std::isfinite(norm(point))) in_.fail("a coordinate is not finite");
      surface_.add_point(point);
    } else if (element.name == "face" && is_face) {
      surface_.add_polygon(corners_);
    }
  }

  InputCursor& in_;
  SurfaceBuilder& surface_;
  PlyFormat format_ = PlyFormat::ascii;
  bool has_format_ = false;
  std::vector<PlyElement> elements_;
  std::vector<std::int64_t> corners_;
};

}  // namespace

void read_ply(InputCursor& in, SurfaceBuilder& surface) { PlyReader(in, surface).run(); }

}  // namespace evert
