// Hazards in the disparity image: a pixel is judged by the disparity that ground would have there.
//
// After M. Azkarate et al., "A GNC architecture for planetary rovers with autonomous navigation", 2020: obstacle where
// d > d_cal h / (h - T_near), hole where d < d_cal h / (h + T_far), in a region of interest, put into a rover-frame
// traversability map. Beyond the paper: the reference follows the ground actually ahead (plane and local ground),
// what was not measured is never free, and every frame is reported.
#pragma once

#include <optional>
#include <vector>

#include "hazard_detector/cell_states.hpp"
#include "hazard_detector/disparity_table.hpp"
#include "hazard_detector/ground_plane.hpp"
#include "hazard_detector/local_ground.hpp"

namespace rover::hazard {

enum class Status { kClear = 0, kHazard = 1, kBlind = 2 };

struct HazardResult {
  Status status = Status::kBlind;  // read first
  double coverage = 0.0;           // of the region of interest
  int hazard_px = 0;               // samples beyond the limits in hazard cells
  double nearest_hazard_m = std::numeric_limits<double>::quiet_NaN();
  GroundPlane plane;
  std::vector<Cell> cells;
};

class HazardDetector {
 public:
  explicit HazardDetector(const HazardConfig& config);

  const GridShape& shape() const { return shape_; }
  // The disparity must have the camera's size.
  HazardResult step(const Disparity& disparity, const StereoCamera& camera);

 private:
  void prepare(const StereoCamera& camera);
  double locate(const Disparity& disparity);
  GroundPlane fit_plane() const;
  LocalGround bend(const GroundPlane& plane) const;
  void judge(const Disparity& disparity, const GroundPlane& plane, const LocalGround& ground);
  void summarize(HazardResult& result) const;

  HazardConfig config_;
  GridShape shape_;
  StereoCamera mount_;  // as the last message gave it
  std::optional<DisparityTable> table_;
  std::vector<std::int16_t> cell_of_sample_;  // -1: no stereo or outside the grid
  std::vector<CellEvidence> evidence_;
};

}  // namespace rover::hazard
