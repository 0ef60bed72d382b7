// Hazard detection in disparity space (M. Azkarate et al., "A GNC architecture for planetary rovers with autonomous
// navigation", 2020): obstacle if d > d_cal h / (h - T_near), hole if d < d_cal h / (h + T_far), mapped into a
// rover-frame grid. Differences: the reference follows the ground ahead (fitted plane and local ground), unmeasured
// cells are never free, and every frame is reported.
#pragma once

#include <optional>
#include <vector>

#include "hazard_detector/cell_classifier.hpp"
#include "hazard_detector/disparity_table.hpp"
#include "hazard_detector/ground_plane.hpp"
#include "hazard_detector/local_ground.hpp"

namespace rover::hazard {

enum class Status { kClear = 0, kHazard = 1, kBlind = 2 };

struct HazardResult {
  Status status = Status::kBlind;  // read first
  double coverage = 0.0;           // fraction of the region of interest with valid stereo
  int hazard_px = 0;               // samples beyond the limits in hazard cells, not pixels
  double nearest_hazard_m = std::numeric_limits<double>::quiet_NaN();
  GroundPlane plane;
  std::vector<Cell> cells;
};

class HazardDetector {
 public:
  explicit HazardDetector(const HazardConfig& config);

  const GridShape& shape() const { return shape_; }
  // Image and camera must have the same size (checked).
  HazardResult step(const Disparity& disparity, const StereoCamera& camera);

 private:
  void update_table(const StereoCamera& camera);
  double accumulate_samples(const Disparity& disparity);
  void classify_samples(const Disparity& disparity, const GroundPlane& plane, const LocalGround& ground);

  HazardConfig config_;
  GridShape shape_;
  StereoCamera camera_;  // of the last frame, without calibration
  std::optional<DisparityTable> table_;
  std::vector<std::int16_t> cell_of_sample_;  // -1: no stereo, or outside the grid
  std::vector<CellEvidence> evidence_;
};

// Steps that need the cells' evidence alone.
GroundPlane fit_plane(const std::vector<CellEvidence>& evidence, const GridShape& shape, const HazardConfig& config);
LocalGround fit_local_ground(const std::vector<CellEvidence>& evidence, const GridShape& shape,
                             const HazardConfig& config, const GroundPlane& plane);
// Status, nearest hazard and number of hazard samples from the classified cells.
void summarize(const std::vector<CellEvidence>& evidence, const GridShape& shape, HazardResult& result);

}  // namespace rover::hazard
