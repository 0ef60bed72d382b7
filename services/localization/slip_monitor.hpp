// Slip: what was commanded, what the wheels rolled and what the images saw, over a sliding window.
//
// All three are lengths of the wheels' way: the visual motion is projected onto each wheel's rolling direction, so that
// turns, point turns included, count like straight driving. The window slides with time, not with motion: it empties at
// standstill instead of freezing.
#pragma once

#include <deque>
#include <vector>

#include "common/core/frames.hpp"
#include "localization/motion_history.hpp"
#include "localization/wheel_odometry.hpp"

namespace rover::loc {

struct SlipConfig {
  double window_s = 5.0;           // HDPR
  double grip_window_s = 2.0;      // for dead reckoning between two visual motions
  double min_wheel_path_m = 0.05;  // in the window; less says nothing
  double min_cover = 0.5;          // share of the wheels' way that images must have seen
  double max_visual_age_s = 1.0;   // the window ends at the newest visual motion, or this long ago
};

struct Slip {
  double window_s = 0.0;
  double commanded_mps = 0.0;
  double wheel_mps = 0.0;
  double visual_mps = kNaN;  // NaN: no visual motion in the window
  double slip_ratio = kNaN;
  bool valid = false;
};

class SlipMonitor {
 public:
  SlipMonitor(const SlipConfig& config, const WheelOdometry& wheels) : config_(config), wheels_(wheels) {}

  void add(const MotionRecord& record);
  // `records` make up the interval; `motion`: (dx, dy, dyaw) of the body over it, in the axes at its start.
  void add_visual(const std::vector<MotionRecord>& records, const Eigen::Vector3d& motion);

  Slip slip(Utime now) const;
  // Metres gained per metre rolled, lately; 1 where unknown.
  double grip() const { return grip_; }
  // Metres gone to the left per metre rolled, ahead or astern, beside what the steering makes: on a side slope the
  // rover drives askew, which wheels cannot tell. 0 where unknown.
  double side_slip() const { return side_slip_; }

 private:
  struct Way {
    Utime start;
    Utime end;
    double commanded_m = 0.0;
    double wheel_m = 0.0;
    double visual_m = 0.0;
    double rolled_m = 0.0;  // of the body's origin
    double aside_m = 0.0;
  };
  static Way sum(const std::deque<Way>& ways, Utime from, Utime to);
  void update_grip();
  void update_side_slip(const Way& way);

  SlipConfig config_;
  WheelOdometry wheels_;
  std::deque<Way> ticks_;
  std::deque<Way> seen_;  // intervals with a visual motion
  double grip_ = 1.0;
  double side_slip_ = 0.0;
};

}  // namespace rover::loc
