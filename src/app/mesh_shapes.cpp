#include "mesh_shapes.hpp"

#include "evert/core/error.hpp"
#include "evert/scene/body_mesh.hpp"

#include "command_options.hpp"
#include <algorithm>
#include <map>
#include <vector>

namespace evert {

GenerateRequest generate_mesh(std::span<const std::string> arguments) {
  const auto shapes = generated_shapes();
  if (arguments.empty() || arguments.front().starts_with('-'))
    throw UserError("evert mesh generate needs a shape: " + list_of(shapes));
  const auto& shape = arguments.front();
  if (std::ranges::find(shapes, shape) == shapes.end())
    throw UserError("evert mesh generate: there is no shape '" + shape + "': must be " + list_of(shapes) +
                    did_you_mean(shape, shapes));
  const auto command = "evert mesh generate " + shape;
  const auto keys = keys_of_generated(shape);
  auto with_value = keys;
  with_value.emplace_back("o");
  const CommandOptions options(command, arguments.subspan(1), with_value, {}, {});
  auto output = options.text("o");
  const auto format = mesh_format_of(output);  // before the work
  std::map<std::string, std::string> given;
  for (const auto& key : keys)
    if (options.has(key)) given[key] = options.text(key);
  return {make_body_mesh(generated_mesh(shape, given, command)), std::move(output), format};
}

}  // namespace evert
