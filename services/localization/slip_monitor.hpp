// Wheel slip over a sliding time window: commanded, rolled and visually measured distance.
//
// All three are distances along the wheels: the visual motion is projected onto each wheel's rolling direction, so
// turns and point turns count like straight driving. The window slides with time, so it empties at standstill.
#pragma once

#include <deque>
#include <vector>

#include "common/core/frames.hpp"
#include "localization/motion_history.hpp"
#include "localization/wheel_odometry.hpp"

namespace rover::loc {

struct SlipConfig {
  double window_s = 5.0;           // HDPR
  double traction_window_s = 2.0;  // for dead reckoning between two visual motions
  double min_wheel_path_m = 0.05;  // less wheel travel in the window gives no slip ratio
  double min_coverage = 0.5;       // fraction of the wheel travel that visual odometry must cover
  double max_visual_age_s = 1.0;   // the window ends at the newest visual motion, at most this long ago
};

struct Slip {
  double window_s = 0.0;
  double commanded_mps = 0.0;
  double wheel_mps = 0.0;
  double visual_mps = kNaN;  // NaN without a visual motion in the window
  double slip_ratio = kNaN;
  bool valid = false;
};

class SlipMonitor {
 public:
  SlipMonitor(const SlipConfig& config, const WheelOdometry& wheels) : config_(config), wheels_(wheels) {}

  void add(const MotionRecord& record);
  // `records` make up the interval; `motion`: (dx, dy, dyaw) of the body on the ground over it, in the axes at its
  // start.
  void add_visual(const std::vector<MotionRecord>& records, const Eigen::Vector3d& motion);

  Slip slip(Utime now) const;
  // Distance gained per distance rolled (1 - slip) over the newest traction_window_s; 1 if unknown. When that is long
  // ago, the mean over 10 m: what the last images before a failure showed may be wrong, and would last.
  double traction(Utime at) const { return is_old(at) ? mean_traction_ : traction_; }
  // Lateral drift to the left per distance rolled, forward or backward, beyond wheel odometry: on a side slope the
  // rover crabs, which wheels cannot measure. 0 if unknown or long ago.
  double side_slip(Utime at) const { return is_old(at) ? 0.0 : side_slip_; }
  double newest_traction() const { return traction_; }
  double newest_side_slip() const { return side_slip_; }
  double mean_traction() const { return mean_traction_; }
  // The window stays empty.
  void restore(double newest_traction, double mean_traction, double side_slip, Utime newest_visual) {
    traction_ = newest_traction;
    mean_traction_ = mean_traction;
    side_slip_ = side_slip;
    newest_visual_ = newest_visual;
  }

 private:
  struct Interval {
    Utime start;
    Utime end;
    double commanded_m = 0.0;
    double wheel_m = 0.0;
    double visual_m = 0.0;
    double body_m = 0.0;  // of the body origin, by wheel odometry
    double lateral_m = 0.0;
  };
  bool is_old(Utime at) const { return at > newest_visual_ + 2 * to_utime(config_.traction_window_s); }
  static Interval sum(const std::deque<Interval>& intervals, Utime from, Utime to);
  void update_traction();
  void update_side_slip(const Interval& interval);

  SlipConfig config_;
  WheelOdometry wheels_;
  std::deque<Interval> ticks_;
  std::deque<Interval> visual_;  // one for each visual motion
  double traction_ = 1.0;
  double mean_traction_ = 1.0;
  Utime newest_visual_ = kNever;
  double side_slip_ = 0.0;
};

}  // namespace rover::loc
