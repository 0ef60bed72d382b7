// The map of hazard_detector made from the true surface: its ground, limits and cell classes, with points of the
// surface in place of stereo samples.
#pragma once

#include <memory>
#include <vector>

#include "hazard_detector/hazard_detector.hpp"
#include "tools/truth_perception/line_of_sight.hpp"

namespace rover::truth {

class TrueHazards {
 public:
  // `camera`: rectified, with its mount.
  TrueHazards(const hazard::HazardConfig& config, const StereoCamera& camera, std::shared_ptr<TrueSurface> surface);

  const hazard::GridShape& shape() const { return shape_; }
  hazard::HazardResult step(const Eigen::Isometry3d& T_map_body);

 private:
  struct SeenPoint {
    int cell;
    Eigen::Vector3d p_body;
  };
  void accumulate(const Eigen::Isometry3d& T_map_body);
  void classify(const hazard::GroundPlane& plane, const hazard::LocalGround& ground);

  hazard::HazardConfig config_;
  hazard::GridShape shape_;
  StereoCamera camera_;
  std::shared_ptr<TrueSurface> surface_;
  std::vector<hazard::CellEvidence> evidence_;
  std::vector<SurfacePoint> in_view_;
  std::vector<SeenPoint> seen_;
};

}  // namespace rover::truth
