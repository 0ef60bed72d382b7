#include "supervisor/node.hpp"

#include <rover/command_ack_t.hpp>
#include <rover/motion_command_t.hpp>
#include <sstream>

#include "common/bus/convert.hpp"
#include "common/bus/s6_client.hpp"
#include "supervisor/convert.hpp"
#include "supervisor/persistent_state_codec.hpp"

namespace rover::supervisor {
namespace {

constexpr Utime kStatePeriodUs = 100'000;
constexpr Utime kFaultPeriodUs = 1'000'000;  // repetition of active faults, for late subscribers

std::string text_of(const StateChange& change) {
  std::ostringstream out;
  if (change.level_from != change.level_to)
    out << "LEVEL from=" << name(change.level_from) << " to=" << name(change.level_to);
  else
    out << "STATE from=" << name(change.from) << " to=" << name(change.to);
  out << " cause=" << change.cause;
  const Evidence& evidence = change.evidence;
  if (!evidence.quantity.empty())
    out << ' ' << evidence.quantity << '=' << evidence.value << " threshold=" << evidence.threshold
        << " age_s=" << evidence.data_age_s;
  return out.str();
}

std::string text_of(const FaultChange& change) {
  std::ostringstream out;
  out << (change.active ? "FAULT_RAISED" : "FAULT_CLEARED") << " id=" << change.id << " value=" << change.value
      << " limit=" << change.limit << " condition=" << static_cast<int>(change.condition);
  return out.str();
}

std::string text_of(const CommandAnswer& answer) {
  return "COMMAND id=" + std::to_string(answer.id) + (answer.accepted ? " accepted" : " refused: " + answer.reason);
}

}  // namespace

SupervisorNode::SupervisorNode(Node& node, const SupervisorConfig& config, Control control)
    : node_(node),
      checkpoint_(node),
      control_(std::move(control)),
      on_demand_services_(config.on_demand_services),
      origin_height_m_(config.origin_height_m),
      supervisor_(config) {
  restore();
  subscribe();
  subscribe_vehicle();
  node_.on_step([this](Utime now) { step(now); });
  node_.on_tick_timeout([this] { withdraw_permit(); });
}

void SupervisorNode::subscribe() {
  node_.subscribe<heartbeat_t>(channel::kHeartbeat, [this](const heartbeat_t& m) {
    pids_[m.header.publisher] = m.pid;
    supervisor_.on_service(m.header.publisher, report_from(m));
  });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& m) {
    const PoseReport report = report_from(m, origin_height_m_);
    body_odom_ = report.odom;
    supervisor_.on_pose(report);
  });
  node_.subscribe<hazards_t>(channel::kHazards, [this](const hazards_t& m) { supervisor_.on_hazards(report_from(m)); });
  node_.subscribe<planner_status_t>(channel::kPlannerStatus,
                                    [this](const planner_status_t& m) { supervisor_.on_planner(report_from(m)); });
  node_.subscribe<path_t>(channel::kPath, [this](const path_t& m) { supervisor_.on_path(levels_from(m)); });
  node_.subscribe<control_status_t>(channel::kControlStatus,
                                    [this](const control_status_t& m) { supervisor_.on_control(report_from(m)); });
  node_.subscribe<traversability_t>(channel::kTraversability, [this](const traversability_t& m) {
    supervisor_.on_terrain(report_from(m, body_odom_));
  });
  node_.subscribe<vo_motion_t>(channel::kVo, [this](const vo_motion_t& m) { supervisor_.on_visual(report_from(m)); });
  node_.subscribe<slam_pose_t>(channel::kSlamPose,
                               [this](const slam_pose_t& m) { supervisor_.on_slam(report_from(m)); });
  node_.subscribe<ground_command_t>(channel::kGroundCommand, [this](const ground_command_t& m) {
    // Localization handles and acknowledges SET_START_POSE.
    if (m.kind != ground_command_t::SET_START_POSE) supervisor_.on_command(command_from(m));
  });
}

void SupervisorNode::subscribe_vehicle() {
  node_.subscribe<slip_t>(channel::kSlip, [this](const slip_t& m) { supervisor_.on_slip(report_from(m)); });
  node_.subscribe<wheel_state_t>(channel::kWheelState,
                                 [this](const wheel_state_t& m) { supervisor_.on_wheels(report_from(m)); });
  node_.subscribe<imu_t>(channel::kImu, [this](const imu_t& m) { supervisor_.on_imu(report_from(m)); });
  node_.subscribe<motion_command_t>(
      channel::kMotionCommand, [this](const motion_command_t& m) { supervisor_.on_motion_command(m.header.utime); });
}

void SupervisorNode::step(Utime now) {
  checkpoint_.publish_restored();
  const SupervisorOutput output = supervisor_.step(now);
  drive_permit_t permit = message_of(output.permit);
  node_.publish(channel::kDrivePermit, permit, now);
  publish_faults(output, now);
  publish_states(output, now);
  publish_answers(output.answers, now);
  for (const std::string& service : output.restarts) restart(service);
  run_full_services(output.run_full);
  save();
}

void SupervisorNode::withdraw_permit() {
  drive_permit_t permit = message_of(Permit{false, 0.0, node_.now(), "no ticks"});
  node_.publish(channel::kDrivePermit, permit, node_.now());
}

void SupervisorNode::publish_answers(const std::vector<CommandAnswer>& answers, Utime now) {
  for (const CommandAnswer& answer : answers) {
    command_ack_t ack{};
    ack.command_id = answer.id;
    ack.accepted = answer.accepted ? 1 : 0;
    ack.reason = answer.reason;
    node_.publish(channel::kCommandAck, ack, now);
    node_.log(answer.accepted ? "INFO" : "WARN", text_of(answer));
  }
}

void SupervisorNode::publish_faults(const SupervisorOutput& output, Utime now) {
  for (const FaultChange& change : output.faults) {
    publish_fault(change, now);
    node_.log(change.active ? "WARN" : "INFO", text_of(change));
  }
  if (output.faults.empty() && node_.once_in(kFaultPeriodUs))
    for (const FaultChange& active : supervisor_.active_report()) publish_fault(active, now);
}

void SupervisorNode::publish_fault(const FaultChange& change, Utime now) {
  fault_t message = message_of(change);
  node_.publish(channel::kFault, message, now);
}

void SupervisorNode::publish_states(const SupervisorOutput& output, Utime now) {
  for (const StateChange& change : output.changes) {
    publish_state(change, now);
    node_.log("INFO", text_of(change));
  }
  if (output.changes.empty() && node_.once_in(kStatePeriodUs)) publish_state(supervisor_.last_change(), now);
}

void SupervisorNode::publish_state(const StateChange& change, Utime now) {
  supervisor_state_t message =
      state_message(change, supervisor_.since(), supervisor_.hazard_stops(), supervisor_.active_faults());
  message.full_stopped = supervisor_.full_services_wanted() ? 0 : 1;
  node_.publish(channel::kState, message, now);
}

// s6 restarts crashed processes by itself; only a hung one must be killed. One that sent no heartbeat since the last
// attempt hangs, too.
void SupervisorNode::restart(const std::string& service) {
  const auto heard = pids_.find(service);
  const bool hangs = heard == pids_.end() || process_alive(heard->second);
  const bool killed = hangs && control_(service, "-k");
  if (heard != pids_.end()) pids_.erase(heard);
  node_.log("WARN", "RESTART service=" + service + " why=" + (hangs ? "hang" : "crash") +
                        (hangs && !killed ? " not possible" : ""));
}

// One in a tick: s6-svc takes milliseconds, and the permit must not wait for all of them.
void SupervisorNode::run_full_services(std::optional<bool> run) {
  if (run) {
    option_ = *run ? "-u" : "-d";
    to_control_ = on_demand_services_;
    for (const std::string& service : on_demand_services_) pids_.erase(service);
    node_.log("INFO", *run ? "FULL_SERVICES started" : "FULL_SERVICES stopped");
  }
  if (to_control_.empty()) return;
  control_(to_control_.back(), option_);
  to_control_.pop_back();
}

void SupervisorNode::restore() {
  checkpoint_.restore([this](const CheckpointStore::Bytes& bytes) {
    const auto persistent_state = persistent_state_from(bytes);
    supervisor_.restore(persistent_state);
    return persistent_state.has_value();
  });
}

// Motor heat changes with every WHEEL_STATE and is saved once per second, as is the time; everything else at once. The
// next attempt on a full disk is a second later.
void SupervisorNode::save() {
  PersistentState persistent_state = supervisor_.persistent_state();
  persistent_state.utime = node_.now();
  PersistentState without_heat = persistent_state;
  without_heat.heat = saved_.heat;
  without_heat.utime = saved_.utime;
  const bool at_once = !not_saved_ && without_heat != saved_;
  if (!at_once && !checkpoint_.due()) return;
  not_saved_ = !checkpoint_.save(bytes_of(persistent_state));
  if (!not_saved_) saved_ = persistent_state;
  node_.set_status(not_saved_ ? heartbeat_t::DEGRADED : heartbeat_t::OK, not_saved_ ? "checkpoint not written" : "");
}

}  // namespace rover::supervisor
