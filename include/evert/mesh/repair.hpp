#pragma once
#include "evert/mesh/mesh.hpp"

#include <string>

/// Checks and repairs of what mesh files bring. Not collective; for the rank that holds the mesh.
namespace evert {

/// Throws UserError when a cell is flat or turned inside out at one of its quadrature points, or has a middle
/// node far from its edge: says how many, the first of them, and how to mend it. `what` names the mesh in the
/// message, e.g. its file.
void require_positive_volumes(const Mesh& mesh, const std::string& what);

/// Renumbers the nodes of every cell of negative volume so that it becomes positive. Returns how many there
/// were.
GlobalIndex reorient(Mesh& mesh);

/// Removes the nodes that no cell uses, from the node sets too; the others keep their order. Returns how
/// many.
GlobalIndex drop_unused_nodes(Mesh& mesh);

/// Keeps only the largest set of cells that share no node with the others, of sets of alike size the first,
/// and the nodes that it uses. Returns how many cells go.
GlobalIndex keep_largest_component(Mesh& mesh);

}  // namespace evert
