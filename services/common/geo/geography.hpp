// Conversion between map coordinates and longitude and latitude, through GDAL.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "common/geo/elevation_raster.hpp"

namespace rover {

// Between map coordinates (metres from the raster's lower left corner) and longitude and latitude in degrees on the
// raster's own planet, planetocentric or -graphic as its projection says.
class Geography {
 public:
  explicit Geography(const ElevationRaster& raster);
  ~Geography();
  // False for a local coordinate system: all conversions are NaN.
  bool is_known() const;
  // NaN outside of the projection.
  Eigen::Vector2d to_map(const Eigen::Vector2d& lon_lat_deg) const;
  Eigen::Vector2d to_lon_lat(const Eigen::Vector2d& map_m) const;

 private:
  struct Transforms;
  std::unique_ptr<Transforms> transforms_;
  Eigen::Vector2d corner_m_;
};

}  // namespace rover
