// What is known of the ground around the rover, from both cameras: for each cell the probability that a wheel cannot
// pass it, and whether it was seen at all. A rolling grid in odom; what leaves the field of view is kept.
#pragma once

#include <cstdint>
#include <limits>

#include "common/core/grid_map.hpp"
#include "path_planner/map/input_grids.hpp"
#include "path_planner/map/view_area.hpp"

namespace rover::planning {

struct BeliefConfig {
  int cells = 280;
  static constexpr double kCellM = 0.1;
  // LocCam: evidence of one frame, in log-odds. Frames are correlated, so each counts less than its error rate allows.
  static constexpr double kPrior = -2.0;
  double hit = 1.5;
  double miss = 0.7;  // within near_range_m; further off in proportion to 1 / range
  double max_evidence = 4.0;
  double near_range_m = 2.0;
  // NavCam: the map shows a step as a ratio of the limit, with this standard deviation.
  double sigma = 0.05;
  double sigma_per_m = 0.008;
  double max_navcam_evidence = 2.5;           // less than the LocCam's, whose picture of near ground is the sharper one
  static constexpr double kDriftPerM = 0.08;  // of wheel odometry alone, as SLAM takes it
  static constexpr double kSurelyFree = 0.02;  // of places below it at most 1 in 1,000 is a hazard (belief.md)
  int unmeasured_frames = 6;  // in a row, in view within near_range_m: a hazard, unless it is surely free
  ViewArea view;
};

struct CellBelief {
  bool known = false;
  bool driven = false;          // a wheel was on it
  bool passed = false;          // the footprint was over it
  std::uint8_t unmeasured = 0;  // frames in a row that should have measured it and did not: no texture, or a drop
  std::uint16_t last_hit = 0;   // frame; two cells of a frame may fall into one cell here
  float unmeasured_range_m = 0.0F;
  float evidence = 0.0F;        // LocCam, log-odds
  float step_ratio = 0.0F;      // NavCam, mean
  float step_sigma = kNoSigma;  // and its standard deviation
  float cost = 0.0F;            // NavCam, cost of driving over it, 0 .. 1
  float tall_evidence = 0.0F;   // LocCam, log-odds that a hazard is too tall to pass under the body
  float tall_fraction = 0.5F;   // NavCam, mean of what its maps say of the same
  float height_m = kNoHeight;   // NavCam, newest; in odom

  static constexpr float kNoSigma = 1e3F;
  static constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();
};

class BeliefMap {
 public:
  explicit BeliefMap(const BeliefConfig& config) : config_(config), map_(config.cells, BeliefConfig::kCellM) {}

  void move_to(Point2 rover) { map_.move_to(rover.x_m, rover.y_m); }
  // One frame of the LocCam.
  void add(const HazardGrid& grid, const Eigen::Isometry3d& T_odom_ground);
  // One map of the NavCam, made with the rover there.
  void add(const TraversabilityGrid& grid, const Pose2& rover, const Footprint& footprint);
  // The rover drove so far on wheel odometry alone: what was seen before lies elsewhere.
  void add_drift(double dead_reckoned_m);
  void mark_driven(const Pose2& pose, const Footprint& footprint);
  // Ground that the operator certifies. Hazards that were seen there stay.
  void mark_known(Point2 center, double radius_m);

  // That a wheel cannot pass the cell.
  double probability(const CellBelief& cell) const;
  // If it is a hazard, whether the body passes over it.
  bool low(const CellBelief& cell) const {
    return cell.tall_evidence + config_.max_navcam_evidence * (2.0 * cell.tall_fraction - 1.0) < 0.0;
  }
  // Not measured by the LocCam from near, where its picture is sharper, and not surely free by what both cameras have
  // seen from afar. Only a look from as near changes that.
  bool unmeasurable(const CellBelief& cell) const;
  const GridMap<CellBelief>& cells() const { return map_; }
  GridMap<CellBelief>& cells() { return map_; }

 private:
  void add_hit(CellIndex index, bool low, double range_m);
  void add_miss(CellBelief& cell, double range_m) const;
  void add_seen(CellBelief& cell, double range_m) const;
  void add_unmeasured(CellBelief& cell, const HazardGrid& grid, Point2 in_body) const;

  BeliefConfig config_;
  GridMap<CellBelief> map_;
  std::uint16_t frame_ = 0;
};

}  // namespace rover::planning
