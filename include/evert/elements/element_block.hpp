#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "evert/core/aligned.hpp"
#include "evert/core/index.hpp"
#include "evert/math/vec3.hpp"
#include "evert/mesh/mesh.hpp"

/// Rest data of all cells of one type and one material on a rank, as structure-of-arrays in batches of `lanes` cells.
namespace evert {

/// A range of batches.
struct BatchRange {
  LocalIndex begin = 0;
  LocalIndex end = 0;
};

struct ElementBlock {
  CellType type = CellType::tet4;
  int lanes = 1;                  ///< cells per batch: the width of the SIMD pack that will read them
  LocalIndex cells = 0;
  BatchRange interior;            ///< batches whose cells touch owned nodes only
  BatchRange boundary;            ///< the others
  AlignedVector<LocalIndex> nodes;   ///< [batch][node of the cell][lane]
  AlignedVector<double> gradients;   ///< tet4: D_m^-1 by columns, [batch][9][lane]; else dN/dX, [batch][point][node][3][lane] [1/m]
  AlignedVector<double> volumes;     ///< quadrature weight × det: [batch][point][lane] [m^3]; 0 in padding lanes
  std::vector<LocalIndex> cell_of_lane;  ///< [batch][lane]: index into the list given to the maker, −1 for padding

  [[nodiscard]] LocalIndex batches() const { return boundary.end; }
};

}  // namespace evert
