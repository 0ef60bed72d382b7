#include "test/bench_faults/ground.hpp"

#include <cmath>
#include <rover/path_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/zone_list.hpp"
#include "test/path_planner/randoms.hpp"

namespace rover::bench_faults {
namespace {

constexpr Utime kPeriodUs = 500'000;
constexpr double kStuckS = 20.0;
constexpr double kMovedM = 0.3;
constexpr int kBends = 6;

}  // namespace

template <class Message>
void Ground::send(const char* channel, Message& message) {
  message.header = streams_.next(channel, now_, now_);
  bus_.publish(channel, &message);
}

void Ground::command(std::int8_t kind, const std::string& target, std::int8_t level) {
  ground_command_t out{};
  out.command_id = ++command_id_;
  out.kind = kind;
  out.target = target;
  out.level = level;
  send(channel::kGroundCommand, out);
}

void Ground::step() {
  const Pose2& pose = rover_.pose();
  if (std::hypot(pose.x_m - moved_from_.x_m, pose.y_m - moved_from_.y_m) > kMovedM ||
      seen_.state().state == supervisor_state_t::STANDBY) {
    moved_from_ = pose;
    moved_at_ = now_;
  }
  if (now_ % kPeriodUs != 0) return;
  clear();
  const bool standby = seen_.state().state == supervisor_state_t::STANDBY;
  if (wish_ == Wish::kDrive)
    drive();
  else if (!standby && seen_.state().state != supervisor_state_t::SAFE)
    command(ground_command_t::STOP);
}

void Ground::clear() {
  for (const auto& [id, response] : seen_.active_faults())
    if (response == fault_t::SAFE || id == "no_path" || id == "blocked") command(ground_command_t::CLEAR_FAULT, id);
  if (seen_.state().state == supervisor_state_t::SAFE) command(ground_command_t::CLEAR_SAFE);
}

bool Ground::stuck() const {
  return to_seconds(now_ - moved_at_) > kStuckS;
}

void Ground::drive() {
  switch (seen_.state().state) {
    case supervisor_state_t::STANDBY:
      if (has_path_ && seen_.planner().path_id >= 0) return command(ground_command_t::GO);
      set_start_pose();
      give_path();
      has_path_ = true;
      return;
    case supervisor_state_t::PAUSED:
      return command(ground_command_t::RESUME);
    case supervisor_state_t::GOAL_REACHED:
      break;
    case supervisor_state_t::BOOT:
      if (seen_.planner().path_id < 0) {
        set_start_pose();
        give_path();
      }
      return;
    default:
      if (!stuck()) return;
  }
  has_path_ = false;
  command(ground_command_t::STOP);
}

void Ground::set_start_pose() {
  field_.remove_rocks();
  ground_command_t out{};
  out.command_id = ++command_id_;
  out.kind = ground_command_t::SET_START_POSE;
  out.position_map_m[0] = rover_.pose().x_m;
  out.position_map_m[1] = rover_.pose().y_m;
  out.position_map_m[2] = rover_.T_map_body().translation().z();
  out.yaw_rad = wrap_angle(rover_.pose().yaw_rad);
  out.sigma_m = 0.05;
  out.sigma_yaw_rad = 0.005;
  out.clear_radius_m = 1.5;
  send(channel::kGroundCommand, out);
}

void Ground::give_path(bool forbid_front) {
  using planning::testing_support::uniform;
  Pose2 at = rover_.pose();
  Zone front{"front", false, {}};
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0.5, -1.0), {2.0, -1.0}, {2.0, 1.0}, {0.5, 1.0}})
    front.points.push_back(Eigen::Vector2d(at.x_m, at.y_m) + Eigen::Rotation2Dd(at.yaw_rad) * p);
  path_t out{};
  out.path_id = ++command_id_;
  out.frame = path_t::MAP;
  out.kind = path_t::GLOBAL;
  out.corridor_half_width_m = 0.75;
  out.goal_tolerance_m = 0.5;
  for (int i = 0; i <= kBends; ++i) {
    out.x_m.push_back(at.x_m);
    out.y_m.push_back(at.y_m);
    out.level.push_back(std::int8_t{path_t::FULL});  // commands choose the level
    out.direction.push_back(std::int8_t{path_t::FORWARD});
    const double distance_m = uniform(random_, 5.0, 8.0);
    at.x_m += distance_m * std::cos(at.yaw_rad);
    at.y_m += distance_m * std::sin(at.yaw_rad);
    at.yaw_rad += (i % 2 == 0 ? 1.0 : -1.0) * to_rad(uniform(random_, 70.0, 120.0));
  }
  out.point_count = static_cast<std::int32_t>(out.x_m.size());
  if (forbid_front) zones_to({front}, out);
  send(channel::kGlobalPath, out);
}

}  // namespace rover::bench_faults
