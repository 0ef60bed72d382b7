// Bins a cloud's points into grid cells and computes one height per cell. A cell with a step (a rock's side) has two:
// the mean, unbiased by depth noise and used for matching, and that of the upper part, which a wheel meets.
#pragma once

#include <vector>

#include "slam/cloud.hpp"

namespace rover::slam {

struct Patch {
  int ix = 0;  // grid cell
  int iy = 0;
  float x_m = 0.0F;  // mean of the points, relative to the body's origin in the grid's axes
  float y_m = 0.0F;
  float z_m = 0.0F;
  float top_m = 0.0F;        // of the upper part; z_m without a step
  float variance_m2 = 0.0F;  // of z_m
  float ray_x_m = 0.0F;      // of the mean: horizontal shift by one sigma of depth
  float ray_y_m = 0.0F;
  float brightness = kNoBrightness;  // mean of the points
};

struct PatchConfig {
  double cell_m = 0.1;
  double max_range_m = 14.0;     // farther points are ignored
  double step_m = 0.08;          // spread of heights within a cell that makes it a step
  double correlated_points = 6;  // at most so many independent points in a cell: neighbours share stereo errors
  double roughness_m = 0.006;    // standard deviation of the ground within a cell
};

class PatchBinner {
 public:
  explicit PatchBinner(const PatchConfig& config);

  // `pose`: of the rover in the grid's frame. Patches are sorted by row, y ascending.
  const std::vector<Patch>& bin_cloud(const AlignedCloud& cloud, const Pose2& pose);

 private:
  struct Sums {
    float weight = 0.0F;
    float x = 0.0F, y = 0.0F, z = 0.0F;
    float ray_x = 0.0F, ray_y = 0.0F, variance = 0.0F, brightness = 0.0F;
    int count = 0;
    void add(const AlignedPoint& point, float px, float py);
  };
  struct Bin {
    float lowest, highest, variance;
    int count;
    Sums all;
    float upper_weight, upper_z;
    int upper_count;
  };

  void assign_bins(const AlignedCloud& cloud, const Pose2& pose);
  bool is_step(const Bin& bin) const;
  Patch patch_of(const Bin& bin, int column, int row) const;

  PatchConfig config_;
  int cells_;
  int origin_x_ = 0, origin_y_ = 0;
  float cos_ = 1.0F, sin_ = 0.0F;
  std::vector<Bin> bins_;
  std::vector<int> bin_of_;       // of each point; -1: out of range
  std::vector<float> x_m_, y_m_;  // of each point, in the grid's axes
  std::vector<Patch> patches_;
};

}  // namespace rover::slam
