#include "path_planner/node.hpp"

#include <array>
#include <cmath>
#include <rover/command_ack_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>

#include "common/core/start_pose.hpp"
#include "path_planner/background_thread.hpp"
#include "path_planner/convert.hpp"

namespace rover::planning {
namespace {

constexpr Utime kRepeatPeriodUs = 1'000'000;       // of PATH: a restarted controller has none
constexpr Utime kFaultClearsUs = 4'000'000;        // a row on the path is cleared by good ones for 1-2 s (fdir.yaml)
constexpr Utime kBackUpPatienceUs = 10'000'000;    // of a fault that may be over by itself
constexpr double kOldestMapS = 5.0;                // at its arrival
constexpr std::int64_t kPathsPerBoot = 1'000'000;  // keeps the path ids of two processes apart
constexpr std::int64_t kBoots = 1'000'000'000;     // a boot id from the clock is larger
constexpr double kMostClearRadiusM = 5.0;          // more than an operator would certify

// By PlannerState and PathKind.
constexpr std::array kStateTexts = {"IDLE", "FOLLOWING", "REPAIRING", "NO_PATH"};
constexpr std::array kKindTexts = {"GLOBAL", "REPAIR", "CONTINUOUS", "BACKTRACK"};

}  // namespace

PathPlannerNode::PathPlannerNode(Node& node, const PathPlannerConfig& config)
    : node_(node),
      checkpoint_(node),
      path_latency_(std::max<Utime>(0, to_utime(config.release_latency_s) - kTickUs)),
      origin_height_m_(config.origin_height_m),
      dead_reckoned_(node.options().cpu_scale),
      planner_(config, node.options().boot_id % kBoots * kPathsPerBoot,
               std::make_shared<BackgroundThread>(to_utime(config.planning_latency_s),
                                                  [&node] { return node.follows_clock(); })) {
  node_.subscribe<path_t>(channel::kGlobalPath, [this](const path_t& m) { on_global_path(m); });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& m) { on_pose(m); });
  node_.subscribe<hazards_t>(channel::kHazards, [this](const hazards_t& m) { on_hazards(m); });
  node_.subscribe<traversability_t>(channel::kTraversability,
                                    [this](const traversability_t& m) { on_traversability(m); });
  node_.subscribe<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& m) { on_state(m); });
  node_.subscribe<ground_command_t>(channel::kGroundCommand,
                                    [this](const ground_command_t& m) { on_ground_command(m); });
  node_.subscribe<fault_t>(channel::kFault, [this](const fault_t& m) { on_fault(m); });
  node_.on_step([this](Utime now) { step(now); });
  checkpoint_.restore([this](const CheckpointStore::Bytes& bytes) { return planner_.restore(bytes); });
}

void PathPlannerNode::on_global_path(const path_t& message) {
  GlobalPath path;
  std::string refusal = global_path_from(message, path);
  if (refusal.empty()) refusal = planner_.set_global_path(path);
  command_ack_t ack{};
  ack.command_id = message.path_id;
  ack.accepted = refusal.empty() ? 1 : 0;
  ack.reason = refusal;
  node_.publish(channel::kCommandAck, ack, node_.now());
  if (!refusal.empty()) node_.reject(channel::kGlobalPath, refusal);
  node_.log(refusal.empty() ? "INFO" : "ERROR", "GLOBAL_PATH id=" + std::to_string(message.path_id) +
                                                    " points=" + std::to_string(message.point_count) +
                                                    (refusal.empty() ? "" : " refused: " + refusal));
}

void PathPlannerNode::on_pose(const pose_t& message) {
  PoseSample sample = pose_from(message, origin_height_m_);
  sample.dead_reckoned_m = dead_reckoned_.add(message);
  planner_.add_pose(sample);
}

void PathPlannerNode::on_hazards(const hazards_t& message) {
  const HazardGrid grid = hazards_from(message);
  if (const std::string fault = grid.fault(); !fault.empty()) return node_.reject(channel::kHazards, fault);
  planner_.add_hazards(grid);
}

void PathPlannerNode::on_traversability(const traversability_t& message) {
  const TraversabilityGrid map = traversability_from(message);
  if (const std::string fault = map.fault(); !fault.empty()) return node_.reject(channel::kTraversability, fault);
  if (map.utime > node_.now()) return node_.reject(channel::kTraversability, "map is from the future");
  if (to_seconds(node_.now() - map.utime) > kOldestMapS * node_.options().cpu_scale)
    return node_.reject(channel::kTraversability, "map is too old");
  planner_.add_traversability(map);
}

void PathPlannerNode::on_state(const supervisor_state_t& message) {
  const bool known = message.level == supervisor_state_t::EFFICIENT || message.level == supervisor_state_t::FULL;
  if (!known) return node_.reject(channel::kState, "unknown level");
  planner_.set_level(message.level == supervisor_state_t::FULL);
  using S = supervisor_state_t;
  const bool waits = message.state == S::FAULT_STOP || message.state == S::PAUSED || message.state == S::STANDBY;
  if (!waits) waits_since_ = kNever;
  if (waits && waits_since_ == kNever) waits_since_ = message.header.utime;
}

// Active faults are repeated. One that is older than the path is not about it, unless it remains although the path
// should have ended it.
void PathPlannerNode::on_fault(const fault_t& message) {
  if (message.response == fault_t::STOP_BACKTRACK && !message.active) planner_.request_back_up(false);
  const bool of_this_path = message.visible_utime > told_at_ || message.header.utime > told_at_ + kFaultClearsUs;
  if (!message.active || !of_this_path) return;
  if (message.response == fault_t::STOP_REPLAN) planner_.request_replan();
  const Utime since = std::max(message.visible_utime, waits_since_);
  const bool lasts = waits_since_ != kNever && message.header.utime > since + kBackUpPatienceUs;
  if (message.response == fault_t::STOP_BACKTRACK && lasts) planner_.request_back_up(true);
}

void PathPlannerNode::on_ground_command(const ground_command_t& message) {
  if (message.kind != ground_command_t::SET_START_POSE) return;
  const double radius = message.clear_radius_m;
  // What localization refuses certifies nothing.
  const std::string_view problem = start_pose_problem(Eigen::Vector3d(message.position_map_m), message.yaw_rad,
                                                      message.sigma_m, message.sigma_yaw_rad);
  if (!problem.empty() || !(radius >= 0.0 && radius <= kMostClearRadiusM))
    return node_.reject(channel::kGroundCommand, "start pose or clear radius out of range");
  planner_.set_start_area({message.position_map_m[0], message.position_map_m[1]}, radius, message.header.utime);
}

void PathPlannerNode::step(Utime now) {
  checkpoint_.publish_restored();
  const PlannerOutput output = planner_.step(now);
  if (output.path) tell_path(*output.path);
  if (output.status.path_id == path_.path_id) repeat_path(now, output.path.has_value());
  planner_status_t status{};
  status_to(output.status, status);
  node_.publish(channel::kPlannerStatus, status, now);
  report(output.status);
  if (checkpoint_.due() || output.path) checkpoint_.save(planner_.save());
}

void PathPlannerNode::repeat_path(Utime now, bool at_once) {
  if (path_.point_count == 0 || (!at_once && now < next_repeat_)) return;
  next_repeat_ = now + kRepeatPeriodUs;
  node_.publish(channel::kPath, path_, now, path_latency_);
}

void PathPlannerNode::tell_path(const LocalPath& path) {
  path_ = path_t{};
  path_to(path, path_);
  told_at_ = node_.now();
  node_.log("INFO", "PATH id=" + std::to_string(path.id) + " kind=" + kKindTexts[static_cast<size_t>(path.kind)] +
                        " points=" + std::to_string(path.points.size()) +
                        " corridor_m=" + std::to_string(path.corridor_half_width_m));
}

void PathPlannerNode::report(const PlannerStatus& status) {
  if (status.state == state_ && status.text == text_) return;
  state_ = status.state;
  text_ = status.text;
  const bool no_path = state_ == PlannerState::kNoPath;
  node_.set_status(no_path ? heartbeat_t::DEGRADED : heartbeat_t::OK, no_path ? text_ : "");
  node_.log(no_path ? "WARNING" : "INFO", std::string("PLANNER state=") + kStateTexts[static_cast<size_t>(state_)] +
                                              " blocked_in_m=" + std::to_string(status.blocked_in_m) +
                                              (text_.empty() ? "" : " text=" + text_));
}

}  // namespace rover::planning
