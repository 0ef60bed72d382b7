// Buffer of IMU and wheel records, one for each tick, so that late visual motions can be fused at their own time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <vector>

#include "common/core/time.hpp"

namespace rover::loc {

// Over (start, end].
struct MotionRecord {
  Utime start = kNever;
  Utime end = kNever;
  bool gyro_valid = false;    // delta_angle_rad is measured
  bool fog_valid = false;     // its z comes from the fibre-optic gyro
  bool force_valid = false;   // delta_velocity_mps is measured
  bool wheels_valid = false;  // wheel_turn_rad is measured
  bool stationary = false;    // wheels still and no body rate for a while
  bool settled = false;       // stationary until the body stopped rocking: the gyros measure their bias
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();  // as measured, with bias
  Eigen::Vector3d delta_velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d wheel_motion = Eigen::Vector3d::Zero();  // dx, dy [m], dyaw [rad] without slip
  std::array<double, 6> wheel_turn_rad{};
  std::array<double, 4> steer_rad{};
  double commanded_path_m = 0.0;

  double dt_s() const { return to_seconds(end - start); }
  // The portion within (from, to].
  MotionRecord clipped(Utime from, Utime to) const;
};

class MotionHistory {
 public:
  explicit MotionHistory(Utime span_us) : span_us_(span_us) {}

  // Each record must start where the last one ended.
  void add(const MotionRecord& record);
  // Records that make up (from, to]; the first and the last are clipped.
  std::vector<MotionRecord> slice(Utime from, Utime to) const;
  bool covers(Utime from, Utime to) const;
  bool empty() const { return records_.empty(); }
  Utime end() const { return records_.back().end; }

 private:
  Utime span_us_;
  std::deque<MotionRecord> records_;
};

}  // namespace rover::loc
