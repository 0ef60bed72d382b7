// Georeference of a file: positions of its pixels on the ground.
#pragma once

#include <gdal_priv.h>

#include <array>
#include <string>
#include <vector>

#include "common/geo/projections.hpp"

namespace rover {

// A rectangle of square pixels in a projection in metres.
struct TargetGrid {
  std::string wkt;
  double west_m = 0.0;
  double south_m = 0.0;
  double resolution_m = 0.0;
  std::int64_t width = 0;
  std::int64_t height = 0;
};

class Placement {
 public:
  // Throws DtmError without a georeference, or if it cannot be converted to metres.
  Placement(GDALDataset& dataset, const std::string& file);

  // A local coordinate system, not on a planet.
  bool is_local() const { return reference_.IsLocal() != 0; }
  // Whether pixels are axis-aligned squares of their nominal size in metres on the ground.
  bool is_metric() const;
  // Larger side of the central pixel on the ground.
  double pixel_m() const;
  // "400 x 300 pixels, 2.1 x 1.6 km"
  std::string size() const;
  // The file's own grid, if metric or local.
  TargetGrid own_grid() const;
  // A grid of about as many pixels in a plane about the centre: inside the map if that covers nearly all of it, else
  // around it. Throws DtmError if the map is too wide for a plane.
  TargetGrid plane_grid() const;

 private:
  Eigen::Vector2d at(double column, double line) const;
  // NaN if the projection has no inverse there.
  Eigen::Vector2d lon_lat_at(double column, double line) const;
  // Ground vectors of one pixel east and one pixel north on the map.
  Eigen::Matrix2d pixel_at(double column, double line) const;
  Eigen::Matrix2d middle_pixel() const { return pixel_at(0.5 * width_, 0.5 * height_); }
  bool is_true_at(double column, double line) const;
  // Points along the four sides of the map, in the plane.
  std::vector<std::vector<Eigen::Vector2d>> sides_in(OGRCoordinateTransformation& to_plane) const;

  std::string file_;
  int width_;
  int height_;
  std::array<double, 6> transform_{};
  OGRSpatialReference reference_;
  CoordinateChange to_lon_lat_;
};

}  // namespace rover
