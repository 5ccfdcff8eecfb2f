#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/scene/config.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace evert {

/// Reads or generates the mesh of a body, as it stands in the file or around the origin: groups and placement
/// are not looked at. `cell_vectors` is that of read_mesh. Not collective: for rank 0. Throws UserError for
/// what the reader or the generator does not accept.
[[nodiscard]] Mesh make_body_mesh(const MeshConfig& mesh, std::string_view cell_vectors = {});

/// The words that 'generate' of a body's mesh allows.
[[nodiscard]] std::vector<std::string> generated_shapes();
/// The keys that go with one of them.
[[nodiscard]] std::vector<std::string> keys_of_generated(const std::string& shape);
/// `mesh: {generate: shape, ...}` with the other keys as a command line has them: YAML, or "1,2,3" for a
/// list. `command` is the place in messages. Throws UserError.
[[nodiscard]] MeshConfig generated_mesh(const std::string& shape,
                                        const std::map<std::string, std::string>& keys,
                                        const std::string& command);

}  // namespace evert
