#include "evert/scene/body_mesh.hpp"

#include "tables.hpp"
#include "yaml.hpp"

namespace evert {

using schema::Value;

std::vector<std::string> generated_shapes() {
  std::vector<std::string> names;
  for (const auto& alternative : mesh_table().info().alternatives)
    if (alternative.by_tag) names.push_back(alternative.name);
  return names;
}

std::vector<std::string> keys_of_generated(const std::string& shape) {
  std::vector<std::string> names;
  for (const auto& alternative : mesh_table().info().alternatives)
    if (alternative.by_tag && alternative.name == shape)
      for (const auto& key : alternative.table->keys) names.push_back(key.name);
  return names;
}

MeshConfig generated_mesh(const std::string& shape, const std::map<std::string, std::string>& keys,
                          const std::string& command) {
  Value map{.kind = Value::Kind::map, .where = command};
  map.set("generate", {.kind = Value::Kind::scalar, .where = command, .text = shape});
  for (const auto& [key, text] : keys) {
    const bool is_bare_list =
        text.find(',') != std::string::npos && text.front() != '[' && text.front() != '{';
    map.set(key, parse_yaml_value(is_bare_list ? "[" + text + "]" : text, command));
  }
  return mesh_table().read(map, "");
}

}  // namespace evert
