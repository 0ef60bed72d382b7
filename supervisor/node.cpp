#include "supervisor/node.hpp"

#include <rover/command_ack_t.hpp>
#include <sstream>

#include "supervisor/convert.hpp"

namespace rover::supervisor {
namespace {

constexpr Utime kStatePeriodUs = 100'000;

std::string text_of(const StateChange& change) {
  std::ostringstream out;
  out << "STATE from=" << name(change.from) << " to=" << name(change.to) << " cause=" << change.cause;
  const Evidence& evidence = change.evidence;
  if (!evidence.quantity.empty())
    out << ' ' << evidence.quantity << '=' << evidence.value << " threshold=" << evidence.threshold
        << " age_s=" << evidence.data_age_s;
  return out.str();
}

std::string text_of(const FaultChange& change) {
  std::ostringstream out;
  out << (change.standing ? "FAULT_RAISED" : "FAULT_CLEARED") << " id=" << change.id << " value=" << change.value
      << " limit=" << change.limit << " condition=" << static_cast<int>(change.condition);
  return out.str();
}

std::string text_of(const CommandAnswer& answer) {
  return "COMMAND id=" + std::to_string(answer.id) + (answer.accepted ? " accepted" : " refused: " + answer.reason);
}

}  // namespace

SupervisorNode::SupervisorNode(Node& node, const SupervisorConfig& config) : node_(node), supervisor_(config) {
  subscribe();
  node_.on_step([this](Utime now) { step(now); });
}

void SupervisorNode::subscribe() {
  node_.subscribe<heartbeat_t>(channel::kHeartbeat, [this](const heartbeat_t& m) {
    supervisor_.on_heartbeat(m.header.publisher, m.header.utime);
  });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& m) { supervisor_.on_pose(report_from(m)); });
  node_.subscribe<hazards_t>(channel::kHazards, [this](const hazards_t& m) { supervisor_.on_hazards(report_from(m)); });
  node_.subscribe<planner_status_t>(channel::kPlannerStatus,
                                    [this](const planner_status_t& m) { supervisor_.on_planner(report_from(m)); });
  node_.subscribe<control_status_t>(channel::kControlStatus,
                                    [this](const control_status_t& m) { supervisor_.on_control(report_from(m)); });
  node_.subscribe<slip_t>(channel::kSlip, [this](const slip_t& m) { supervisor_.on_slip(report_from(m)); });
  node_.subscribe<ground_command_t>(channel::kGroundCommand, [this](const ground_command_t& m) {
    // Localization takes the start pose, and answers for it.
    if (m.kind != ground_command_t::SET_START_POSE) supervisor_.on_command(command_from(m));
  });
}

void SupervisorNode::step(Utime now) {
  const SupervisorOutput output = supervisor_.step(now);
  drive_permit_t permit = message_of(output.permit);
  node_.publish(channel::kDrivePermit, permit, now);
  publish_changes(output, now);
  for (const CommandAnswer& answer : output.answers) {
    command_ack_t ack{};
    ack.command_id = answer.id;
    ack.accepted = answer.accepted ? 1 : 0;
    ack.reason = answer.reason;
    node_.publish(channel::kCommandAck, ack, now);
    node_.log(answer.accepted ? "INFO" : "WARN", text_of(answer));
  }
}

void SupervisorNode::publish_changes(const SupervisorOutput& output, Utime now) {
  for (const FaultChange& change : output.faults) {
    fault_t message = message_of(change);
    node_.publish(channel::kFault, message, now);
    node_.log(change.standing ? "WARN" : "INFO", text_of(change));
  }
  for (const StateChange& change : output.changes) {
    publish_state(change, now);
    node_.log("INFO", text_of(change));
  }
  if (output.changes.empty() && now % kStatePeriodUs == 0) publish_state(supervisor_.last_change(), now);
}

void SupervisorNode::publish_state(const StateChange& change, Utime now) {
  supervisor_state_t message =
      state_message(change, supervisor_.since(), supervisor_.hazard_stops(), supervisor_.standing_faults());
  node_.publish(channel::kState, message, now);
}

}  // namespace rover::supervisor
