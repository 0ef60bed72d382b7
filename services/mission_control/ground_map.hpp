// The orbital map as the operator sees it: relief, slope, difficulty; and what a drawn path meets on it.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <vector>

namespace rover::mission {

// Heights, lower left corner at the map's origin, rows from the south.
struct GroundHeights {
  int columns = 0;
  int rows = 0;
  double resolution_m = 1.0;
  std::vector<float> z_m;
};

struct SlopeLimits {
  double warn_rad = 0.17;
  double most_rad = 0.26;
};

struct PathCheck {
  bool inside = true;    // all of it on the map
  bool passable = true;  // nowhere steeper than the limit
  double length_m = 0.0;
  double max_slope_rad = 0.0;
  std::vector<double> distance_m;  // along the path, with
  std::vector<double> slope_rad;   // the steepest slope there in any direction
  std::vector<double> height_m;
};

class GroundMap {
 public:
  GroundMap(GroundHeights heights, const SlopeLimits& limits, double rover_length_m);

  double width_m() const { return heights_.columns * heights_.resolution_m; }
  double height_m() const { return heights_.rows * heights_.resolution_m; }
  double resolution_m() const { return heights_.resolution_m; }

  std::vector<std::uint8_t> relief_jpeg() const;
  // PNG with transparency, one pixel a cell.
  std::vector<std::uint8_t> slope_png() const;
  // Four classes of the worst slope within the rover's length: easy, moderate, hard, impassable.
  std::vector<std::uint8_t> difficulty_png() const;

  PathCheck check(const std::vector<Eigen::Vector2d>& points) const;

 private:
  void measure_slopes(double rover_length_m);
  bool contains(const Eigen::Vector2d& p) const;
  double height_at(const Eigen::Vector2d& p) const;
  size_t index_of(const Eigen::Vector2d& p) const;

  GroundHeights heights_;
  SlopeLimits limits_;
  std::vector<float> slope_rad_;
  std::vector<float> worst_slope_rad_;  // within the rover's length
};

}  // namespace rover::mission
