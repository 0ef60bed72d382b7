// What IMU and wheels measured, tick by tick, over the last minute: visual odometry comes late and is fitted in where
// it belongs.
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
  bool gyro = false;      // delta_angle_rad is measured
  bool fog = false;       // its z is the fibre-optic gyro's
  bool force = false;     // delta_velocity_mps is measured
  bool wheels = false;    // turned_rad is measured
  bool standing = false;  // the wheels have stood for a while and the gyro sees no turning
  bool at_rest = false;   // so long that the body rocks no more: what the gyros measure is their bias
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();  // as measured, with bias
  Eigen::Vector3d delta_velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d wheel_motion = Eigen::Vector3d::Zero();  // dx, dy [m], dyaw [rad] without slip
  std::array<double, 6> turned_rad{};
  std::array<double, 4> steer_rad{};
  double commanded_path_m = 0.0;

  double dt_s() const { return to_seconds(end - start); }
  // The part of the record within (from, to].
  MotionRecord part(Utime from, Utime to) const;
};

class MotionHistory {
 public:
  explicit MotionHistory(Utime span_us) : span_us_(span_us) {}

  // Records come in order and without holes.
  void add(const MotionRecord& record);
  // Records that make up (from, to], the first and the last cut to fit.
  std::vector<MotionRecord> slice(Utime from, Utime to) const;
  bool covers(Utime from, Utime to) const;
  bool empty() const { return records_.empty(); }
  Utime end() const { return records_.back().end; }
  const MotionRecord& newest() const { return records_.back(); }

 private:
  Utime span_us_;
  std::deque<MotionRecord> records_;
};

}  // namespace rover::loc
