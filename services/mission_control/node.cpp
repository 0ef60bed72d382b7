#include "mission_control/node.hpp"

#include <cmath>
#include <cstring>
#include <sstream>
#include <utility>

#include "common/bus/convert.hpp"
#include "common/bus/service_names.hpp"
#include "common/bus/state_names.hpp"
#include "common/bus/zone_list.hpp"
#include "mission_control/view.hpp"

namespace rover {
namespace {

using mission::CommandKind;
using mission::Tone;

constexpr std::int64_t kCommandsPerBoot = 100'000;  // keeps the ids of two processes apart
constexpr std::int64_t kMaxBoots = 1'000'000'000;   // keeps ids exact in JavaScript numbers
constexpr Utime kTrackPeriodUs = 5'000'000;
constexpr Utime kTrendPeriodUs = 1'000'000;
constexpr Utime kHeartbeatCheckPeriodUs = 200'000;
constexpr Utime kStopRepeatPeriodUs = 200'000;
constexpr Utime kStopRepeatsEndUs = 3'000'000;
constexpr size_t kMaxUnacknowledgedPaths = 4;

ground_command_t command_message(std::int8_t kind, std::int64_t command_id) {
  ground_command_t message{};
  message.kind = kind;
  message.command_id = command_id;
  message.level = ground_command_t::AUTO;
  return message;
}

std::int8_t kind_of(CommandKind kind) {
  switch (kind) {
    case CommandKind::kGo:
      return ground_command_t::GO;
    case CommandKind::kPause:
      return ground_command_t::PAUSE;
    case CommandKind::kResume:
      return ground_command_t::RESUME;
    case CommandKind::kEmergencyStop:
      return ground_command_t::EMERGENCY_STOP;
    case CommandKind::kClearSafe:
      return ground_command_t::CLEAR_SAFE;
    case CommandKind::kForceLevel:
      return ground_command_t::FORCE_LEVEL;
    case CommandKind::kClearFault:
      return ground_command_t::CLEAR_FAULT;
    default:
      return ground_command_t::STOP;
  }
}

std::int8_t level_of(mission::Level level) {
  switch (level) {
    case mission::Level::kEfficient:
      return ground_command_t::EFFICIENT;
    case mission::Level::kFull:
      return ground_command_t::FULL;
    default:
      return ground_command_t::AUTO;
  }
}

GlobalPath path_of(const mission::Command& command, const std::vector<Zone>& zones,
                   const mission::OperatorPathConfig& path_config) {
  GlobalPath path;
  path.zones = zones;
  for (const Eigen::Vector2d& p : command.points) {
    path.x_m.push_back(p.x());
    path.y_m.push_back(p.y());
    path.level.push_back(level_of(command.level));
  }
  path.corridor_half_width_m = path_config.corridor_half_width_m;
  path.goal_tolerance_m = path_config.goal_tolerance_m;
  return path;
}

// Of a path under way, from where the rover is: what lies behind it may be forbidden now.
GlobalPath rest_of(GlobalPath path, const Eigen::Vector2d& rover) {
  size_t nearest = 0;
  double min_m = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 1 < path.x_m.size(); ++i) {
    const Eigen::Vector2d from(path.x_m[i], path.y_m[i]),
        along = Eigen::Vector2d(path.x_m[i + 1], path.y_m[i + 1]) - from;
    const double u = std::clamp((rover - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance_m = (from + u * along - rover).norm();
    if (!(distance_m < min_m)) continue;
    min_m = distance_m;
    nearest = i;
  }
  const auto behind = static_cast<std::ptrdiff_t>(nearest);
  path.x_m.erase(path.x_m.begin(), path.x_m.begin() + behind);
  path.y_m.erase(path.y_m.begin(), path.y_m.begin() + behind);
  path.level.erase(path.level.begin(), path.level.begin() + behind);
  path.x_m.front() = rover.x();
  path.y_m.front() = rover.y();
  return path;
}

std::string cause_text(const supervisor_state_t& state) {
  std::ostringstream out;
  out.precision(3);
  out << ": " << state.cause;
  if (!state.quantity.empty() && std::isfinite(state.value))
    out << " (" << state.quantity << " " << state.value << ", limit " << state.threshold << ")";
  return out.str();
}

Tone tone_of(std::int8_t state) {
  switch (state) {
    case supervisor_state_t::FAULT_STOP:
    case supervisor_state_t::SAFE:
      return Tone::kBad;
    case supervisor_state_t::HAZARD_STOP:
    case supervisor_state_t::PAUSED:
      return Tone::kWarn;
    case supervisor_state_t::DRIVING:
    case supervisor_state_t::GOAL_REACHED:
      return Tone::kGood;
    default:
      return Tone::kInfo;
  }
}

std::string mission_step_name(MissionStep mission_step) {
  return mission_step == MissionStep::kStartPose ? "start pose" : mission_step == MissionStep::kPath ? "path" : "go";
}

}  // namespace

MissionControlNode::MissionControlNode(Node& node, MissionPlan plan, std::shared_ptr<mission::SharedState> shared,
                                       mission::OperatorPathConfig path_config, std::function<void()> each_tick)
    : node_(node),
      checkpoint_(node),
      plan_(std::move(plan)),
      shared_(std::move(shared)),
      path_config_(std::move(path_config)),
      each_tick_(std::move(each_tick)),
      next_command_id_(node.options().boot_id % kMaxBoots * kCommandsPerBoot + 1) {
  restore();
  subscribe();
  node_.on_step([this](Utime now) { step(now); });
}

void MissionControlNode::subscribe() {
  node_.subscribe<command_ack_t>(channel::kCommandAck, [this](const command_ack_t& ack) { on_ack(ack); });
  node_.subscribe<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& m) { on_state(m); });
  node_.subscribe<fault_t>(channel::kFault, [this](const fault_t& m) { on_fault(m); });
  node_.subscribe<heartbeat_t>(channel::kHeartbeat, [this](const heartbeat_t& m) { on_heartbeat(m); });
  node_.subscribe<path_t>(channel::kPath, [this](const path_t& m) { on_path(m); });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& m) { on_pose(m); });
  node_.subscribe<slip_t>(channel::kSlip,
                          [this](const slip_t& m) { slip_ratio_ = m.valid == 1 ? m.slip_ratio : kNaN; });
}

void MissionControlNode::add_event(Tone tone, const std::string& kind, const std::string& text) {
  shared_->book.with([&](mission::Logbook& book) { book.add_event(to_seconds(node_.now()), tone, kind, text); });
  changed_ = true;
}

void MissionControlNode::on_ack(const command_ack_t& ack) {
  const bool accepted = ack.accepted != 0;
  unanswered_stops_.erase(ack.command_id);
  if (const auto mission_step = sequence_.current(); sequence_.acknowledge(ack.command_id, accepted, ack.reason)) {
    node_.log(accepted ? "INFO" : "WARN", "PLAN_COMMAND id=" + std::to_string(ack.command_id) +
                                              (accepted ? " accepted" : " refused: " + ack.reason));
    if (accepted) add_event(Tone::kInfo, "command", "mission plan: " + mission_step_name(mission_step) + " accepted");
  } else if (const auto command = shared_->commands.acknowledge(ack.command_id, accepted, ack.reason)) {
    add_event(accepted ? Tone::kInfo : Tone::kWarn, "command",
              mission::description(*command) + (accepted ? " accepted" : " refused: " + ack.reason));
    if (accepted) accepted_by_operator(*command, ack.command_id);
  }
  if (const auto path = unacknowledged_paths_.find(ack.command_id); path != unacknowledged_paths_.end()) {
    if (accepted) {
      shared_->book.with([&](mission::Logbook& book) { book.set_path(ack.command_id, path->second); });
      unacknowledged_paths_.erase(unacknowledged_paths_.begin(), std::next(path));  // and those lost before
    } else {
      unacknowledged_paths_.erase(path);
    }
  }
}

void MissionControlNode::accepted_by_operator(const mission::Command& command, std::int64_t command_id) {
  node_.log("INFO", "COMMAND id=" + std::to_string(command_id) + " accepted: " + mission::description(command));
  if (command.kind == CommandKind::kForceLevel)
    shared_->book.with([&](mission::Logbook& book) { book.set_forced(command.level); });
}

void MissionControlNode::on_state(const supervisor_state_t& state) {
  standby_ = state.state == supervisor_state_t::STANDBY;
  if (state_ && state.state != state_->state)
    add_event(tone_of(state.state), "state", state_name(state.state) + cause_text(state));
  if (state_ && state.level != state_->level)
    add_event(Tone::kInfo, "level", "level " + level_name(state.level) + cause_text(state));
  if (state_ && state.full_stopped != state_->full_stopped) {
    const bool run = state.full_stopped == 0;
    add_event(Tone::kInfo, "service",
              std::string("services of the Full level ") + (run ? "are started" : "are stopped"));
    if (!run) std::erase_if(liveness_, [](const auto& service) { return is_full_service(service.first); });
  }
  end_plan(state);
  state_ = state;
}

// Otherwise GO would follow at a later STANDBY, although it took effect (its acknowledgement was lost), or although
// only the operator may decide to drive.
void MissionControlNode::end_plan(const supervisor_state_t& state) {
  using S = supervisor_state_t;
  const bool go_done = sequence_.current() == MissionStep::kGo && state.state != S::BOOT && state.state != S::STANDBY;
  const bool operator_decides = state.state == S::SAFE || state.state == S::TELEOP;
  if (sequence_.all_accepted() || !(go_done || operator_decides)) return;
  sequence_.cancel();
  add_event(Tone::kInfo, "command", "mission plan: ended in state " + state_name(state.state));
}

void MissionControlNode::on_fault(const fault_t& fault) {
  const bool active = fault.active == 1;
  bool& known = faults_[fault.id];
  if (active == known) return;  // repeated
  known = active;
  std::ostringstream text;
  text.precision(3);
  text << fault.id << (active ? " raised" : " cleared");
  if (active && std::isfinite(fault.value)) text << " (" << fault.value << ", limit " << fault.limit << ")";
  const bool serious = fault.response != fault_t::LOG && fault.response != fault_t::SLOW;
  add_event(!active ? Tone::kGood : serious ? Tone::kBad : Tone::kWarn, "fault", text.str());
}

void MissionControlNode::on_heartbeat(const heartbeat_t& heartbeat) {
  if (state_ && state_->full_stopped != 0 && is_full_service(heartbeat.service)) return;
  ServiceLiveness& liveness = liveness_[heartbeat.service];
  if (liveness.last_heartbeat != kNever && heartbeat.header.boot_id != liveness.boot_id)
    add_event(Tone::kGood, "service", heartbeat.service + " restarted");
  else if (liveness.timed_out)
    add_event(Tone::kGood, "service", heartbeat.service + " sends heartbeats again");
  liveness = {heartbeat.header.boot_id, heartbeat.header.utime, false};
}

void MissionControlNode::on_path(const path_t& path) {
  if (path.path_id == path_id_) return;
  path_id_ = path.path_id;
  if (path.kind == path_t::REPAIR) add_event(Tone::kInfo, "path", "path repaired around hazards");
  if (path.kind == path_t::BACKTRACK) add_event(Tone::kWarn, "path", "backtracking along the driven track");
}

// Before the start pose is accepted the rover's position in map is undefined.
void MissionControlNode::on_pose(const pose_t& pose) {
  pose_ = pose;
  const bool known = pose.status == pose_t::OK || pose.status == pose_t::DEGRADED;
  if (!known || sequence_.progress() == static_cast<int>(MissionStep::kStartPose)) return;
  const Eigen::Vector3d p =
      pose_from(pose.position_map_odom_m, pose.quat_map_odom_wxyz) * Eigen::Vector3d(pose.position_odom_body_m);
  p_map_body_ = p.head<2>();
  shared_->book.with([&](mission::Logbook& book) { book.add_track_point(p.x(), p.y()); });
}

void MissionControlNode::sample(Utime now) {
  const Eigen::Vector3d rpy = rpy_of(pose_from(pose_.position_odom_body_m, pose_.quat_odom_body_wxyz).rotation());
  const mission::TrendSample moment{to_seconds(now), static_cast<float>(pose_.velocity_body_mps[0]),
                                    static_cast<float>(slip_ratio_), static_cast<float>(rpy.x()),
                                    static_cast<float>(rpy.y())};
  shared_->book.with([&](mission::Logbook& book) { book.sample(moment); });
}

void MissionControlNode::step(Utime now) {
  checkpoint_.publish_restored();
  shared_->now_s = to_seconds(now);
  while (const auto waiting = shared_->commands.next()) send(*waiting);
  if (const auto issued = sequence_.step(now, standby_, next_command_id_)) {
    ++next_command_id_;
    changed_ = true;
    send(*issued);
  }
  repeat_stops(now);
  if (node_.once_in(kHeartbeatCheckPeriodUs)) check_heartbeats(now);
  if (node_.once_in(kTrendPeriodUs)) sample(now);
  report_status();
  save(now);
  if (each_tick_) each_tick_();
}

void MissionControlNode::check_heartbeats(Utime now) {
  for (auto& [name, liveness] : liveness_) {
    if (liveness.timed_out || now - liveness.last_heartbeat < mission::kHeartbeatTimeoutUs) continue;
    liveness.timed_out = true;
    add_event(Tone::kBad, "service", name + ": heartbeat timeout");
  }
}

void MissionControlNode::report_status() {
  if (!sequence_.refusal().empty())
    node_.set_status(heartbeat_t::DEGRADED, sequence_.refusal());
  else if (!shared_->page_is_served)
    node_.set_status(heartbeat_t::DEGRADED, "the page's address is in use");
  else
    node_.set_status(heartbeat_t::OK, "");
}

void MissionControlNode::send(const MissionSequence::Issued& issued) {
  switch (issued.mission_step) {
    case MissionStep::kStartPose:
      return publish_start_pose(issued.command_id);
    case MissionStep::kPath:
      return publish_path(issued.command_id, plan_.path);
    case MissionStep::kGo:
      return publish(command_message(ground_command_t::GO, issued.command_id));
  }
}

void MissionControlNode::send(const mission::CommandQueue::Pending& waiting) {
  const mission::Command& command = waiting.command;
  const std::int64_t id = next_command_id_++;
  changed_ = true;
  shared_->commands.set_command_id(waiting.ticket, id);
  // A stop, CLEAR_SAFE or a new path replaces the plan, which must not continue by itself.
  const bool clear_safe = command.kind == CommandKind::kClearSafe;
  if (mission::stops(command.kind) || clear_safe || command.kind == CommandKind::kPath) sequence_.cancel();
  if (command.kind == CommandKind::kPath) return publish_path(id, path_of(command, current_path().zones, path_config_));
  if (command.kind == CommandKind::kZones) return send_zones(id, command.zones);
  if (command.kind == CommandKind::kLocate) return locate(id, command.within_m);
  ground_command_t message = command_message(kind_of(command.kind), id);
  message.level = level_of(command.level);
  message.target = command.target;
  publish(message);
  if (mission::stops(command.kind))
    unanswered_stops_[id] = {message, node_.now() + kStopRepeatPeriodUs, node_.now() + kStopRepeatsEndUs};
}

void MissionControlNode::publish_start_pose(std::int64_t command_id) {
  ground_command_t message = command_message(ground_command_t::SET_START_POSE, command_id);
  message.position_map_m[0] = plan_.start.pose.x_m;
  message.position_map_m[1] = plan_.start.pose.y_m;
  message.position_map_m[2] = plan_.start.z_m;
  message.yaw_rad = plan_.start.pose.yaw_rad;
  message.sigma_m = plan_.start.sigma_m;
  message.sigma_yaw_rad = plan_.start.sigma_yaw_rad;
  message.clear_radius_m = plan_.start.clear_radius_m;
  publish(message);
}

// The start pose again, as uncertain as the operator says: global_localization then searches for the rover there.
void MissionControlNode::locate(std::int64_t command_id, double within_m) {
  constexpr double kSigmas = 3.0;  // of the search window
  const auto refuse = [&](const char* why) { shared_->commands.acknowledge(command_id, false, why); };
  if (!p_map_body_) return refuse("the rover has no position yet");
  if (!state_ || state_->level != supervisor_state_t::FULL) return refuse("only the Full level maps the ground");
  if (state_->state == supervisor_state_t::DRIVING) return refuse("the rover drives; pause it first");
  const Eigen::Isometry3d T_map_body = pose_from(pose_.position_map_odom_m, pose_.quat_map_odom_wxyz) *
                                       pose_from(pose_.position_odom_body_m, pose_.quat_odom_body_wxyz);
  ground_command_t message = command_message(ground_command_t::SET_START_POSE, command_id);
  Eigen::Map<Eigen::Vector3d>(message.position_map_m) = T_map_body.translation();
  message.yaw_rad = rpy_of(T_map_body.rotation()).z();
  message.sigma_m = within_m / kSigmas;
  message.sigma_yaw_rad = std::sqrt(pose_.covariance[35]);
  publish(message);
}

void MissionControlNode::publish(ground_command_t message) {
  node_.publish(channel::kGroundCommand, message, node_.now());
}

// A datagram may be lost. The supervisor refuses a copy of a stop that has taken effect.
void MissionControlNode::repeat_stops(Utime now) {
  std::erase_if(unanswered_stops_, [now](const auto& stop) { return now >= stop.second.give_up_at; });
  for (auto& [id, stop] : unanswered_stops_) {
    if (now < stop.repeat_at) continue;
    stop.repeat_at = now + kStopRepeatPeriodUs;
    publish(stop.message);
  }
}

// The last one sent, as long as the rover has not refused it; the plan's before it is sent.
GlobalPath MissionControlNode::current_path() const {
  if (!unacknowledged_paths_.empty()) return unacknowledged_paths_.rbegin()->second;
  const GlobalPath path = shared_->book.with([](const mission::Logbook& book) { return book.path(); });
  return path.x_m.empty() ? plan_.path : path;
}

// With the path under way. Before the rover has one the page does not show the zones of the plan: it would delete them.
void MissionControlNode::send_zones(std::int64_t command_id, const std::vector<Zone>& zones) {
  if (shared_->book.with([](const mission::Logbook& book) { return book.path().x_m.empty(); })) {
    shared_->commands.acknowledge(command_id, false, "the rover has no path yet");
    return;
  }
  GlobalPath path = current_path();
  const bool behind = forbidding_zone(zones, {path.x_m.front(), path.y_m.front()}) != nullptr;
  if (behind && p_map_body_) path = rest_of(std::move(path), *p_map_body_);
  path.zones = zones;
  publish_path(command_id, path);
}

void MissionControlNode::publish_path(std::int64_t command_id, const GlobalPath& path) {
  path_t message{};
  message.path_id = command_id;
  message.frame = path_t::MAP;
  message.kind = path_t::GLOBAL;
  message.corridor_half_width_m = path.corridor_half_width_m;
  message.goal_tolerance_m = path.goal_tolerance_m;
  message.point_count = static_cast<std::int32_t>(path.x_m.size());
  message.x_m = path.x_m;
  message.y_m = path.y_m;
  message.level = path.level;
  zones_to(path.zones, message);
  message.direction.assign(path.x_m.size(), std::int8_t{path_t::FORWARD});
  node_.publish(channel::kGlobalPath, message, node_.now());
  unacknowledged_paths_[command_id] = path;
  if (unacknowledged_paths_.size() > kMaxUnacknowledgedPaths)
    unacknowledged_paths_.erase(unacknowledged_paths_.begin());
}

// Checkpoint layout: plan progress, next command id, logbook.
void MissionControlNode::restore() {
  checkpoint_.restore([this](const CheckpointStore::Bytes& bytes) {
    std::int64_t head[2];
    if (bytes.size() < sizeof head) return false;
    std::memcpy(head, bytes.data(), sizeof head);
    const std::vector<std::uint8_t> book(bytes.begin() + sizeof head, bytes.end());
    if (!shared_->book.with([&](mission::Logbook& b) { return b.restore(book); })) return false;
    sequence_.resume_at(static_cast<int>(head[0]));
    saved_progress_ = sequence_.progress();
    next_command_id_ = std::max(next_command_id_, head[1]);
    return true;
  });
}

// Plan progress is saved at once: a restart must repeat no accepted step and no cancelled plan.
void MissionControlNode::save(Utime now) {
  const bool progressed = std::exchange(saved_progress_, sequence_.progress()) != sequence_.progress();
  changed_ = changed_ || progressed;
  if (!progressed && (!checkpoint_.due() || (!changed_ && now < track_saved_ + kTrackPeriodUs))) return;
  const std::int64_t head[2] = {sequence_.progress(), next_command_id_};
  CheckpointStore::Bytes bytes(sizeof head);
  std::memcpy(bytes.data(), head, sizeof head);
  const auto book = shared_->book.with([](const mission::Logbook& b) { return b.save(); });
  bytes.insert(bytes.end(), book.begin(), book.end());
  if (!checkpoint_.save(bytes)) return;
  changed_ = false;
  track_saved_ = now;
}

}  // namespace rover
