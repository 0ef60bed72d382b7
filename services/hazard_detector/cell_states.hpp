// From the evidence in the cells to the traversability map.
#pragma once

#include <vector>

#include "hazard_detector/grid.hpp"

namespace rover::hazard {

std::vector<Cell> cell_states(const std::vector<CellEvidence>& evidence, const GridShape& shape,
                              const HazardConfig& config);

}  // namespace rover::hazard
