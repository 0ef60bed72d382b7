#include "tools/replay/pacer.hpp"

#include <algorithm>

#include "common/core/frames.hpp"

namespace rover::replay {

void Pacer::go_from(Utime t, double wall_s) {
  anchor_us_ = static_cast<double>(t);
  anchor_wall_s_ = wall_s;
}

double Pacer::due(double wall_s) const {
  return paused_ ? anchor_us_ : anchor_us_ + (wall_s - anchor_wall_s_) * speed_ * 1e6;
}

void Pacer::pause(double wall_s) {
  anchor_us_ = due(wall_s);
  paused_ = true;
}

void Pacer::resume(double wall_s) {
  anchor_wall_s_ = wall_s;
  paused_ = false;
}

void Pacer::set_speed(double speed, double wall_s) {
  anchor_us_ = due(wall_s);
  anchor_wall_s_ = wall_s;
  speed_ = speed;
}

double Pacer::wait_s(Utime t, double wall_s) const {
  if (paused_) return kInfinity;
  if (speed_ == 0.0) return 0.0;
  return std::max(0.0, (static_cast<double>(t) - due(wall_s)) * 1e-6 / speed_);
}

}  // namespace rover::replay
