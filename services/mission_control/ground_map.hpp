// The operator's view of the orbital map: relief, slope and difficulty images, and slope checks of drawn paths.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/frames.hpp"

namespace rover::mission {

// Heights; origin at the lower left corner, rows ordered south to north.
struct GroundHeights {
  int columns = 0;
  int rows = 0;
  double resolution_m = 1.0;
  std::vector<float> z_m;
};

struct SlopeLimits {
  double steep_rad = to_rad(10.0);  // warned of
  double max_rad = to_rad(15.0);    // impassable
};

struct PathCheck {
  bool inside = true;    // the whole path is on the map
  bool passable = true;  // slope limit met everywhere
  double length_m = 0.0;
  double max_slope_rad = 0.0;
  std::vector<double> distance_m;  // along the path
  std::vector<double> slope_rad;   // steepest slope in any direction at distance_m
  std::vector<double> height_m;
};

class GroundMap {
 public:
  GroundMap(GroundHeights heights, const SlopeLimits& limits, double rover_length_m);

  double width_m() const { return heights_.columns * heights_.resolution_m; }
  double height_m() const { return heights_.rows * heights_.resolution_m; }
  double resolution_m() const { return heights_.resolution_m; }

  std::vector<std::uint8_t> relief_jpeg() const;
  // PNG with alpha channel, one pixel per cell.
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
