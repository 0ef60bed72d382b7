// Gaze control of the NavCam at the Full level: along the path while driving, all round in a sweep.
#pragma once

#include <optional>

#include "common/core/pan_tilt.hpp"
#include "common/core/time.hpp"
#include "pan_tilt/look_ahead.hpp"
#include "pan_tilt/sweep.hpp"

namespace rover::gaze {

struct PanTiltConfig {
  LookAheadConfig ahead;
  SweepConfig sweep;
  double image_distance_m = 0.5;         // distance between images ahead,
  double image_turn_rad = to_rad(12.0);  // or turn of the rover or of the view
  double glance_rad = to_rad(40.0);      // of every second image ahead, alternating sides; 0: none
  double stuck_s = 3.0;                  // stuck for so long: one sweep
  double dwell_s = 0.2;                  // from arrival to the end of the exposure
  double arrival_margin_s = 2.0;         // beyond the longest move: unit timed out
  double arrival_rad = to_rad(1.0);
  double max_pose_age_s = 0.3;
};

enum class Task {
  kIdle,   // Efficient level
  kAhead,  // looks along the path
  kSweep,  // repeated sweeps
  kStuck   // stopped by hazards: as kAhead, with one sweep after stuck_s
};

struct RoverPose {
  Utime utime = kNever;
  Pose2 odom;
  double travelled_m = 0.0;
};

struct UnitState {
  Utime utime = kNever;
  Gaze gaze;
  bool moving = false;
};

class PanTilt {
 public:
  PanTilt(const PanTiltConfig& config, const PanTiltUnit& unit, const CameraMount& mount);

  void set_path(Path path) { path_ = std::move(path); }  // empty: looks straight ahead
  void set_pose(const RoverPose& pose) { pose_ = pose; }
  void set_unit_state(const UnitState& unit) { unit_state_ = unit; }

  // The next view to take an image of, if one is due.
  std::optional<Gaze> step(Utime now, Task task);

  // The unit did not reach its last target in time.
  bool unit_timed_out() const { return unit_timed_out_; }

 private:
  struct Pending {
    Gaze gaze;
    Utime since;
    Utime arrived = kNever;
  };
  void start_task(Utime now, Task task);
  bool image_pending(Utime now);
  double longest_move_s() const;
  std::optional<Gaze> next_view(Utime now);
  std::optional<Gaze> next_sweep_view();
  std::optional<Gaze> look_ahead_view(Utime now);
  bool moved_enough() const;
  bool turned_enough(double heading_rad) const;
  double glance_rad() const;

  PanTiltConfig config_;
  PanTiltUnit unit_;
  CameraMount mount_;
  std::vector<Gaze> sweep_;
  Path path_;
  RoverPose pose_;
  UnitState unit_state_;
  Task task_ = Task::kIdle;
  Utime task_since_ = kNever;
  size_t sweep_next_ = 0;
  std::optional<Pending> pending_;
  std::optional<RoverPose> last_image_;  // pose of the last image ahead
  double last_view_heading_rad_ = 0.0;   // heading of its view in odom
  int images_since_turn_ = 0;            // images ahead since the last one due to a turn
  bool unit_timed_out_ = false;
};

}  // namespace rover::gaze
