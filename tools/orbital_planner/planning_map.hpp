// The map that a plan is made on, with its terrain.
#pragma once

#include <cstdint>
#include <string>

#include "common/geo/elevation_map.hpp"
#include "tools/orbital_planner/terrain.hpp"

namespace rover::orbital {

struct PlanningMap {
  ElevationMap map;  // at the layers' cell size
  TerrainLayers terrain;
};

struct MapLimits {
  std::int64_t pixels = kMaxPixelsInMemory;  // a larger map is read in strips and its pixels are merged
  std::int64_t cells = 16'000'000;           // at most, after merging; planning needs 60 bytes each
};

// Throws DtmError.
PlanningMap read_planning_map(const std::string& file, const TerrainConfig& config, const MapLimits& limits = {});

}  // namespace rover::orbital
