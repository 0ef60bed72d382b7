// A cloud's points gathered in the cells of a lattice: one height for each cell that the cloud sees.
// Where a cell holds a step (a rock's flank) it has two: the mean, which noise of depth does not shift and with which
// clouds are matched, and that of the upper part, which a wheel meets.
#pragma once

#include <vector>

#include "slam/cloud.hpp"

namespace rover::slam {

struct Patch {
  int ix = 0;  // of the lattice
  int iy = 0;
  float x_m = 0.0F;  // mean of the points, from the body's origin in the lattice's axes, as all that follows
  float y_m = 0.0F;
  float z_m = 0.0F;
  float top_m = 0.0F;        // of the upper part; z_m where there is no step
  float variance_m2 = 0.0F;  // of z_m
  float ray_x_m = 0.0F;      // one sigma of depth, as in LevelPoint, of the mean
  float ray_y_m = 0.0F;
  int points = 0;
};

struct PatchConfig {
  double cell_m = 0.1;
  double reach_m = 14.0;         // points further off are left out
  double step_m = 0.08;          // spread of a cell's heights from which it counts as a step
  double correlated_points = 6;  // neighbours share their stereo error: so many count as one at best
  double roughness_m = 0.006;    // of the ground within a cell
};

class PatchGatherer {
 public:
  explicit PatchGatherer(const PatchConfig& config);

  // `pose`: of the rover in the lattice's frame. Patches come in rows of growing y.
  const std::vector<Patch>& gather(const LevelCloud& cloud, const Pose2& pose);

 private:
  struct Sums {
    float weight = 0.0F;
    float x = 0.0F, y = 0.0F, z = 0.0F;
    float ray_x = 0.0F, ray_y = 0.0F, variance = 0.0F;
    int count = 0;
    void add(const LevelPoint& point, float px, float py);
  };
  struct Bin {
    float lowest, highest, variance;
    int count;
    Sums all;
    float upper_weight, upper_z;
    int upper_count;
  };

  void sort_in(const LevelCloud& cloud, const Pose2& pose);
  bool is_step(const Bin& bin) const;
  Patch patch_of(const Bin& bin, int column, int row) const;

  PatchConfig config_;
  int cells_;
  int origin_x_ = 0, origin_y_ = 0;
  float cos_ = 1.0F, sin_ = 0.0F;
  std::vector<Bin> bins_;
  std::vector<int> bin_of_;       // of each point, -1: out of reach
  std::vector<float> x_m_, y_m_;  // of each point, in the lattice's axes
  std::vector<Patch> patches_;
};

}  // namespace rover::slam
