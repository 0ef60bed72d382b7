// Directs the NavCam: along the path while the rover drives, all round while it sweeps. Of the Full level alone.
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
  double image_way_m = 0.5;              // an image each so much of way,
  double image_turn_rad = to_rad(12.0);  // or of turn of the rover, or of the view
  double glance_rad = to_rad(40.0);      // of every second image along the way, to either side in turns; 0: none
  double stuck_s = 3.0;                  // without a way on for so long: one sweep
  double dwell_s = 0.2;                  // from standing there to the picture's end
  double arrival_slack_s = 2.0;          // beyond the time that the way takes: the unit does not come
  double arrival_rad = to_rad(1.0);
  double max_pose_age_s = 0.3;
};

enum class Task {
  kIdle,   // not the Full level
  kAhead,  // looks where the rover goes
  kSweep,  // again and again
  kStuck   // stands before hazards: ahead, after a while one sweep, then ahead again
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

  void take_path(Path path) { path_ = std::move(path); }  // empty: none to look along
  void take_pose(const RoverPose& pose) { pose_ = pose; }
  void take_unit(const UnitState& unit) { unit_state_ = unit; }

  // Where to look and make a picture next, when it is time.
  std::optional<Gaze> step(Utime now, Task task);

  // The unit did not come where it was last told.
  bool unit_fails() const { return unit_fails_; }

 private:
  struct Pending {
    Gaze gaze;
    Utime since;
    Utime arrived = kNever;
  };
  void begin(Utime now, Task task);
  bool picture_pending(Utime now);
  double longest_move_s() const;
  std::optional<Gaze> next_view(Utime now);
  std::optional<Gaze> sweep_on();
  std::optional<Gaze> ahead(Utime now);
  bool went_on() const;
  bool turned_on(double heading_rad) const;
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
  std::optional<RoverPose> last_image_;  // where the last one along the way was made
  double last_heading_rad_ = 0.0;        // of its view, in odom
  int images_of_way_ = 0;                // since the last one that a turn asked for
  bool unit_fails_ = false;
};

}  // namespace rover::gaze
