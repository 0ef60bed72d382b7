// Fast marching (Sethian, PNAS 1996): the travel cost T with |grad T| = cost per metre, from the seeds to every cell.
// First order upwind differences, binary heap; ties are broken by the cell's number.
#pragma once

#include <vector>

namespace rover {

struct Seed {
  int cell = 0;
  double travel_cost = 0.0;
};

struct MarchGrid {
  int width = 0;
  int height = 0;
  double cell_m = 0.0;
  std::vector<double> cost_per_m;  // row-major; infinity: impassable
};

// Stops once the front has passed the cell `target` by `beyond` of travel cost (target < 0: marches everywhere).
// Infinity for cells that the front has not reached.
std::vector<double> march(const MarchGrid& grid, const std::vector<Seed>& seeds, int target, double beyond);

}  // namespace rover
