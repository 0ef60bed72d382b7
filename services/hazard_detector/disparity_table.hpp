// The look-up table: for each sampled pixel the disparity of flat ground, d_cal (Azkarate et al. 2020, section on
// hazard detection), with the ray that turns a disparity into a point. Samples are spread evenly over the ground rather
// than over the image: near rows, where a cell has hundreds of pixels, are thinned out.
#pragma once

#include <vector>

#include "common/core/disparity_plane.hpp"
#include "hazard_detector/hazard_config.hpp"

namespace rover::hazard {

struct Sample {
  int index;  // v * width + u
  float u, v;
  float d_cal_px16;           // 1/16 px
  float ray_x, ray_y, ray_z;  // body axes, per unit of depth
  bool in_roi;                // seen by both cameras and within the region of interest on flat ground
};

class DisparityTable {
 public:
  // `camera` with the calibration already applied.
  DisparityTable(const StereoCamera& camera, const HazardConfig& config);

  const StereoCamera& camera() const { return camera_; }
  const std::vector<Sample>& samples() const { return samples_; }
  // d_cal as a plane in the disparity image.
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
