// Where the pixels of a file lie on the ground.
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
  // Throws DtmError where the dataset has no georeference, or one that no grid in metres can be made of.
  Placement(GDALDataset& dataset, const std::string& file);

  // In a coordinate system of its own, on no planet.
  bool is_local() const { return reference_.IsLocal() != 0; }
  // Whether each pixel is a square of its nominal size on the ground, in metres, with its sides along the axes.
  bool is_metric() const;
  // Of a pixel in the middle: the greater of its sides on the ground.
  double pixel_m() const;
  // "400 x 300 pixels, 2.1 x 1.6 km"
  std::string size() const;
  // The file's own grid where that is metric or local.
  TargetGrid own_grid() const;
  // A grid of about as many pixels in the plane about the middle: inside of the map where that is nearly all of it,
  // else around it. Throws DtmError where the map is too wide for any plane.
  TargetGrid plane_grid() const;

 private:
  Eigen::Vector2d at(double column, double line) const;
  // NaN where the projection leads to none.
  Eigen::Vector2d lon_lat_at(double column, double line) const;
  // On the ground, for a step of a pixel eastwards and of a pixel northwards on the map.
  Eigen::Matrix2d pixel_at(double column, double line) const;
  Eigen::Matrix2d middle_pixel() const { return pixel_at(0.5 * width_, 0.5 * height_); }
  bool is_true_at(double column, double line) const;
  // Points along the four sides of the map in the plane.
  std::vector<std::vector<Eigen::Vector2d>> sides_in(OGRCoordinateTransformation& to_plane) const;

  std::string file_;
  int width_;
  int height_;
  std::array<double, 6> transform_{};
  OGRSpatialReference reference_;
  CoordinateChange to_lon_lat_;
};

}  // namespace rover
