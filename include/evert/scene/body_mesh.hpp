#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/scene/config.hpp"

#include <string_view>

namespace evert {

/// Reads or generates the mesh of a body, as it stands in the file or around the origin: groups and placement
/// are not looked at. `cell_vectors` is that of read_mesh. Not collective: for rank 0. Throws UserError for
/// what the reader or the generator does not accept.
[[nodiscard]] Mesh make_body_mesh(const MeshConfig& mesh, std::string_view cell_vectors = {});

}  // namespace evert
