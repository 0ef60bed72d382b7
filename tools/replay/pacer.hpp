// Computes the wall time at which a tick is due, with playback speed, pause and seek.
#pragma once

#include "common/core/time.hpp"

namespace rover::replay {

// Wall times are arguments [s] with an arbitrary origin.
class Pacer {
 public:
  // speed 0: as fast as possible.
  explicit Pacer(double speed) : speed_(speed) {}

  // Restarts the pacing from message time t: at the start and after a seek.
  void go_from(Utime t, double wall_s);
  void pause(double wall_s);
  void resume(double wall_s);
  void set_speed(double speed, double wall_s);

  // Wall time until t is due [s]; 0 if overdue, infinity while paused.
  double wait_s(Utime t, double wall_s) const;
  bool paused() const { return paused_; }
  double speed() const { return speed_; }

 private:
  // Message time that is due now [us].
  double due(double wall_s) const;

  double speed_;
  bool paused_ = false;
  double anchor_us_ = 0.0;  // message time at anchor_wall_s_
  double anchor_wall_s_ = 0.0;
};

}  // namespace rover::replay
