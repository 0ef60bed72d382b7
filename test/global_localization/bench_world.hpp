// Worlds and drives of the bench, and the distortion of their orbital maps.
#pragma once

#include <vector>

#include "global_localization/height_grid.hpp"
#include "rover_simulator/world/world.hpp"
#include "test/global_localization/mapped_drive.hpp"

namespace rover::global::test {

HeightGrid grid_of(const ElevationRaster& raster);

// Horizontal displacement field of a world's orbital map, and its rigid approximation over part of the map.
class MapDistortion {
 public:
  MapDistortion(const WorldConfig& config, const ElevationRaster& dtm, std::uint64_t seed, double resolution_m);

  // Best rigid transform (least squares) from true to map coordinates over these points.
  Eigen::Isometry2d rigid(const std::vector<Eigen::Vector2d>& ground) const;

 private:
  Eigen::Vector2d at(const Eigen::Vector2d& p) const;

  ElevationRaster east_, north_;
};

// Drivable lines over the elevation model: slope at most 15 deg over the rover's length.
std::vector<Line> drivable_lines(const World& world, double length_m, int count, std::uint64_t seed);

}  // namespace rover::global::test
