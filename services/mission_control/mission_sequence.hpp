// Issues the commands of a mission plan in sequence: start pose, global path, go. A command without acknowledgement, or
// a refused one, is repeated every second.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "common/core/zones.hpp"

namespace rover {

// Start pose estimate in map, with its standard deviation.
struct StartPose {
  Pose2 pose;
  double z_m = 0.0;
  double sigma_m = 0.1;
  double sigma_yaw_rad = 0.02;
  double clear_radius_m = 1.5;  // certified free of hazards, because the cameras never see the ground under the rover
};

struct GlobalPath {
  std::vector<double> x_m;  // map
  std::vector<double> y_m;
  std::vector<std::int8_t> level;
  double corridor_half_width_m = 1.5;
  double goal_tolerance_m = 0.5;
  std::vector<Zone> zones;
};

enum class MissionStep { kStartPose, kPath, kGo };

class MissionSequence {
 public:
  struct Issued {
    MissionStep mission_step;
    std::int64_t command_id;
  };

  // Returns the command to issue now, if any. GO requires `standby`. `command_id` must be unused; it is consumed only
  // if a command is returned.
  std::optional<Issued> step(Utime now, bool standby, std::int64_t command_id);
  // Returns true if the acknowledgement belongs to the current command.
  bool acknowledge(std::int64_t command_id, bool accepted, const std::string& reason);

  // The next or unacknowledged step; undefined if all are accepted.
  MissionStep current() const { return next_; }
  bool all_accepted() const { return next_ > MissionStep::kGo; }
  // Ends the sequence because the operator took over or the rover drives.
  void cancel() {
    next_ = static_cast<MissionStep>(static_cast<int>(MissionStep::kGo) + 1);
    refusal_.clear();
  }
  // Checkpointed over restarts. An invalid number restarts the sequence.
  int progress() const { return static_cast<int>(next_); }
  void resume_at(int progress);
  // Reason of the last refusal; empty if the last command was not refused.
  const std::string& refusal() const { return refusal_; }

 private:
  MissionStep next_ = MissionStep::kStartPose;
  std::int64_t command_id_ = 0;
  Utime issued_at_ = kNever;
  std::string refusal_;
};

}  // namespace rover
