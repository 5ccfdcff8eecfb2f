#pragma once

namespace evert {

/// Throws UserError, naming the memory it would take, when a mesh of that many cells and nodes has more than
/// 2^31 cells or would not fit into the memory of this machine.
void require_possible_size(double cells, double nodes);

}  // namespace evert
