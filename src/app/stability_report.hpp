#pragma once
#include "evert/filter/shape_class.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

/// What `evert stability` finds, and how it says it.
namespace evert {

/// One element at one state.
struct ElementRecord {
  GlobalIndex cell = 0;     ///< counted over all bodies from 0
  std::int32_t region = 0;  ///< index into DistributedMesh::regions
  CellType type = CellType::tet4;
  ShapeClass shape = ShapeClass::well_shaped;  ///< of tetrahedra with four nodes
  double own = 0;                              ///< λ(K_e, M_e) with its own masses [1/s²]
  double nodal = 0;                            ///< with the masses of its nodes [1/s²]
  double energy = 0;                           ///< its share of the energy of the fastest vibration
};

/// A body at one state: squared frequencies [1/s²].
struct StabilityFindings {
  double truth = 0;
  double collatz_wielandt = 0;
  double balanced = 0;  ///< of the elements with the masses that `time_step: auto` splits
  double eq8 = 0, eq9 = 0;
  double lanczos = 0;
  std::vector<ElementRecord> elements;  ///< on rank 0: of all ranks, by cell
};

/// The table of bounds, the shapes, the histogram and the elements to blame, of the state called `state`.
void write_stability(const StabilityFindings& findings, const std::string& state,
                     const std::vector<std::string>& regions, std::ostream& out);

/// One line an element.
void write_element_table(const StabilityFindings& findings, const std::vector<std::string>& regions,
                         std::ostream& out);

}  // namespace evert
