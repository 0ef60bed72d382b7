// Look-up table: for each sampled pixel the disparity of flat ground, d_cal (Azkarate et al. 2020, hazard detection),
// and the viewing ray. Samples are evenly spaced on the ground, not in the image: near rows are subsampled.
#pragma once

#include <vector>

#include "common/core/disparity_plane.hpp"
#include "hazard_detector/hazard_config.hpp"

namespace rover::hazard {

struct Sample {
  int index;  // v * width + u
  float u, v;
  float d_cal_px16;           // 1/16 px
  float ray_x, ray_y, ray_z;  // body frame, per metre of depth
  bool in_roi;                // on flat ground: inside the region of interest and seen by both cameras
};

class DisparityTable {
 public:
  // `camera` must have the calibration applied.
  DisparityTable(const StereoCamera& camera, const HazardConfig& config);

  const StereoCamera& camera() const { return camera_; }
  const std::vector<Sample>& samples() const { return samples_; }
  // d_cal as a linear function of pixel coordinates.
  const DisparityPlane& flat_ground() const { return flat_ground_; }
  double height_m() const { return height_m_; }

 private:
  void add_row(int v, int step_u, const HazardConfig& config);

  StereoCamera camera_;
  DisparityPlane flat_ground_;
  double height_m_;
  std::vector<Sample> samples_;
};

}  // namespace rover::hazard
