// Orbital maps as files, and places on them as longitude and latitude, through GDAL.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "rover_simulator/world/elevation_raster.hpp"

namespace rover::orbital {

struct OrbitalMap {
  ElevationRaster raster;    // NaN where the file has no data
  bool reprojected = false;  // what was read is the copy, not the file as it is
};

// Any elevation model with georeference. One that is not in metres, north-up and of square pixels is reprojected first,
// to a stereographic projection about its middle (`copy_file`, a GeoTIFF), and so is one whose heights are scaled: the
// map frame is the copy's then. Throws DtmError with one line that names the file.
OrbitalMap read_map(const std::string& file, const std::string& copy_file);

// Between map coordinates (from the raster's lower left corner) and longitude and latitude in degrees on the raster's
// own planet, planetocentric or -graphic as its projection says.
class Geography {
 public:
  explicit Geography(const ElevationRaster& raster);
  ~Geography();
  // Longitude, latitude. NaN where the projection has no such place.
  Eigen::Vector2d to_map(const Eigen::Vector2d& lon_lat_deg) const;
  Eigen::Vector2d to_lon_lat(const Eigen::Vector2d& map_m) const;

 private:
  struct Transforms;
  std::unique_ptr<Transforms> transforms_;
  Eigen::Vector2d corner_m_;
};

}  // namespace rover::orbital
