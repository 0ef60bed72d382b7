// Classifies each cell from its evidence: connected components of hazard samples, region growing, inflation.
#pragma once

#include <vector>

#include "hazard_detector/grid.hpp"

namespace rover::hazard {

std::vector<Cell> classify_cells(const std::vector<CellEvidence>& evidence, const GridShape& shape,
                                 const HazardConfig& config);

}  // namespace rover::hazard
