// Rock field from Golombek's size-frequency law, generated per cell from hashes: a pure function of seed and position.
// Law: cumulative fractional area covered by rocks of diameter >= D is F(D) = k exp(-q D), q = 1.79 + 0.152 / k
// (Golombek and Rapp 1997). Shapes: convex blocks of steep flanks under a domed or tilted top.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rover {

struct Rock {
  int id = -1;
  double x_m = 0.0;
  double y_m = 0.0;
  double diameter_m = 0.0;
  double height_m = 0.0;
  std::uint64_t shape_seed = 0;
};

// Circle without rocks of this height or taller.
struct KeepClear {
  double x_m = 0.0;
  double y_m = 0.0;
  double radius_m = 0.0;
  double height_m = 0.12;
  double start_sigma_m = 0.0;  // of the start pose at its centre; above 0 it holds where the rover really stands
};

// Zone with its own rock abundance: all points within the half width of a polyline (a circle for a single point).
struct RockZone {
  double k = 0.0;
  double half_width_m = 0.0;
  std::vector<double> x_m, y_m;

  bool contains(double px_m, double py_m) const;
};

struct RockConfig {
  double k = 0.08;              // cumulative fractional area of all rocks; 0: none
  std::vector<RockZone> zones;  // the first matching zone applies
  double min_diameter_m = 0.08;
  double max_diameter_m = 1.5;
  double min_height_ratio = 0.3;  // height over diameter, spread around Golombek's 1/2
  double max_height_ratio = 0.7;
};

// Rocks per square metre with diameter >= D outside the zones: the integral of -dF / (pi D^2 / 4).
double rock_density_above(const RockConfig& config, double diameter_m);

class RockField {
 public:
  RockField(const RockConfig& config, double width_m, double height_m, std::span<const KeepClear> keep_clear,
            std::uint64_t seed);

  struct Hit {
    int rock_id = -1;
    double height_m = 0.0;  // of the rock's surface over the ground
  };
  // The highest rock surface at this position.
  Hit at(double x_m, double y_m) const;
  // Rocks whose centre is in the box, by increasing id.
  std::vector<Rock> in(double x0_m, double y0_m, double x1_m, double y1_m) const;
  std::span<const Rock> all() const { return rocks_; }

 private:
  static constexpr int kFlanks = 6;
  struct Shape {
    float x_m, y_m, reach_m, height_m;
    float axis_x, axis_y;               // direction of the long axis
    float inverse_long, inverse_short;  // 1 / semi-axis [1/m]
    float dome, tilt_x, tilt_y;
    std::array<float, kFlanks> flank_x, flank_y, flank_offset, flank_rise;
  };

  // Density and size distribution for one abundance.
  struct Law {
    double per_square_metre = 0.0;
    std::vector<double> quantile_diameter_m;  // at equal steps of probability
  };

  static Law law_of(const RockConfig& config, double k);
  static double draw_diameter_m(const Law& law, double u);
  const Law& law_at(double x_m, double y_m) const;
  Shape shape_of(const Rock& rock) const;
  static float profile_m(const Shape& shape, float dx_m, float dy_m);
  void draw_cell(int cx, int cy, std::span<const KeepClear> keep_clear, std::uint64_t seed);
  void index_rocks();
  template <class F>
  void for_cells_of(const Shape& shape, F&& f) const;

  RockConfig config_;
  double width_m_;
  double height_m_;
  std::vector<Law> laws_;  // of the ground, then of each zone
  std::vector<Rock> rocks_;
  std::vector<Shape> shapes_;
  int cells_x_ = 0;
  int cells_y_ = 0;
  std::vector<int> cell_start_;  // rocks that reach into a cell: cell_rocks_[cell_start_[c] .. cell_start_[c + 1])
  std::vector<int> cell_rocks_;
};

}  // namespace rover
