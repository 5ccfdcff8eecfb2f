#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/mesh/mesh_writer.hpp"

#include <span>
#include <string>

namespace evert {

/// What `evert mesh generate` was asked for.
struct GenerateRequest {
  Mesh mesh;
  std::string output;  ///< of -o
  MeshFormat format;   ///< of its extension
};

/// `arguments`: a shape and its options. Throws UserError for bad usage or impossible sizes.
[[nodiscard]] GenerateRequest generate_mesh(std::span<const std::string> arguments);

}  // namespace evert
