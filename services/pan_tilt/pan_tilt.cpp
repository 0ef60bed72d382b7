#include "pan_tilt/pan_tilt.hpp"

#include <algorithm>
#include <cmath>

namespace rover::gaze {

PanTilt::PanTilt(const PanTiltConfig& config, const PanTiltUnit& unit, const CameraMount& mount)
    : config_(config), unit_(unit), mount_(mount), sweep_(sweep_views(config.sweep)) {}

std::optional<Gaze> PanTilt::step(Utime now, Task task) {
  if (task != task_) start_task(now, task);
  if (task_ == Task::kIdle || image_pending(now)) return std::nullopt;
  auto view = next_view(now);
  if (!view) return std::nullopt;
  *view = {unit_.clamp_pan(view->pan_rad), unit_.clamp_tilt(view->tilt_rad)};
  pending_ = Pending{*view, now};
  return view;
}

void PanTilt::start_task(Utime now, Task task) {
  if (task_ == Task::kIdle) {
    pending_.reset();
    last_image_.reset();
  }
  task_ = task;
  task_since_ = now;
  sweep_next_ = 0;
}

// A new command cancels the previous one, so wait for its image.
bool PanTilt::image_pending(Utime now) {
  if (!pending_) return false;
  const auto off_target = [&](double actual, double target) { return std::abs(actual - target) > config_.arrival_rad; };
  const bool at_target = unit_state_.utime > pending_->since && !unit_state_.moving &&
                         !off_target(unit_state_.gaze.pan_rad, pending_->gaze.pan_rad) &&
                         !off_target(unit_state_.gaze.tilt_rad, pending_->gaze.tilt_rad);
  if (at_target && pending_->arrived == kNever) pending_->arrived = now;
  const bool done = pending_->arrived != kNever && to_seconds(now - pending_->arrived) >= config_.dwell_s;
  const bool timed_out =
      pending_->arrived == kNever && to_seconds(now - pending_->since) > longest_move_s() + config_.arrival_margin_s;
  if (!done && !timed_out) return true;
  unit_timed_out_ = timed_out;
  pending_.reset();
  return false;
}

double PanTilt::longest_move_s() const {
  return std::max(2.0 * unit_.pan_max_rad, unit_.tilt_max_rad - unit_.tilt_min_rad) / unit_.rate_radps;
}

std::optional<Gaze> PanTilt::next_view(Utime now) {
  if (task_ == Task::kSweep) {
    sweep_next_ %= sweep_.size();  // repeats while the task lasts
    return next_sweep_view();
  }
  if (task_ == Task::kStuck && to_seconds(now - task_since_) >= config_.stuck_s && sweep_next_ < sweep_.size())
    return next_sweep_view();
  return look_ahead_view(now);
}

// Resets last_image_, so that an image ahead follows the sweep at once.
std::optional<Gaze> PanTilt::next_sweep_view() {
  last_image_.reset();
  return sweep_[sweep_next_++];
}

std::optional<Gaze> PanTilt::look_ahead_view(Utime now) {
  const double age_s = to_seconds(now - pose_.utime);
  if (pose_.utime == kNever || age_s < 0.0 || age_s > config_.max_pose_age_s) return std::nullopt;
  Gaze gaze = look_ahead(path_, pose_.odom, mount_, config_.ahead);
  const double heading = pose_.odom.yaw_rad + gaze.pan_rad;
  const bool turned = !last_image_ || turned_enough(heading);
  if (!turned && !moved_enough()) return std::nullopt;
  images_since_turn_ = turned ? 0 : images_since_turn_ + 1;
  gaze.pan_rad += glance_rad();
  last_image_ = pose_;
  last_view_heading_rad_ = heading;
  return gaze;
}

bool PanTilt::moved_enough() const {
  return std::abs(pose_.travelled_m - last_image_->travelled_m) >= config_.image_distance_m;
}

bool PanTilt::turned_enough(double heading_rad) const {
  const auto turned = [&](double from, double to) { return std::abs(wrap_angle(to - from)) >= config_.image_turn_rad; };
  return turned(last_image_->odom.yaw_rad, pose_.odom.yaw_rad) || turned(last_view_heading_rad_, heading_rad);
}

// The planner needs the ground beside the path; a glance is cheaper than a point turn.
double PanTilt::glance_rad() const {
  if (images_since_turn_ % 2 == 0) return 0.0;
  return images_since_turn_ % 4 == 1 ? config_.glance_rad : -config_.glance_rad;
}

}  // namespace rover::gaze
