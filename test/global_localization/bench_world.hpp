// The worlds and drives of the bench, and the place where a distorted orbital map shows the ground.
#pragma once

#include <vector>

#include "global_localization/height_grid.hpp"
#include "rover_simulator/world/world.hpp"
#include "test/global_localization/mapped_drive.hpp"

namespace rover::global::test {

HeightGrid grid_of(const ElevationRaster& raster);

// How far the orbital map of a world shows the ground from its true place (without the world's relief, which does not
// matter for it), and the rigid motion that this makes of a part of the map.
class MapDistortion {
 public:
  MapDistortion(const WorldConfig& config, const ElevationRaster& dtm, std::uint64_t seed, double resolution_m);

  // Takes true coordinates into those of the map as well as a rigid motion can over this ground.
  Eigen::Isometry2d rigid(const std::vector<Eigen::Vector2d>& ground) const;

 private:
  Eigen::Vector2d at(const Eigen::Vector2d& p) const;

  ElevationRaster east_, north_;
};

// Lines over the elevation model that a rover can drive: nowhere steeper than 15 deg over its own length.
std::vector<Line> drivable_lines(const World& world, double length_m, int count, std::uint64_t seed);

}  // namespace rover::global::test
