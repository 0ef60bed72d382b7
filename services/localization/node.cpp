#include "localization/node.hpp"

#include <rover/command_ack_t.hpp>

#include "localization/convert.hpp"

namespace rover::loc {
namespace {

constexpr Utime kSlipPeriodUs = 5 * kTickUs;  // short against the slip window of 5 s

const char* to_string(PoseStatus status) {
  switch (status) {
    case PoseStatus::kOk:
      return "OK";
    case PoseStatus::kDegraded:
      return "DEGRADED";
    case PoseStatus::kLost:
      return "LOST";
    case PoseStatus::kUninitialised:
      break;
  }
  return "UNINITIALISED";
}

}  // namespace

LocalizationNode::LocalizationNode(Node& node, const LocalizationConfig& config, const Vehicle& vehicle)
    : node_(node), checkpoint_(node), localization_(config, vehicle) {
  if (!config.camera_only.enabled) subscribe_vehicle();
  subscribe();
  restore();
  node_.on_step([this](Utime now) { on_step(now); });
}

void LocalizationNode::subscribe_vehicle() {
  node_.subscribe<imu_t>(channel::kImu,
                         [this](const imu_t& m) { check(channel::kImu, localization_.add_imu(imu_from(m))); });
  node_.subscribe<wheel_state_t>(channel::kWheelState, [this](const wheel_state_t& m) {
    check(channel::kWheelState, localization_.add_wheels(wheels_from(m)));
  });
  node_.subscribe<wheel_command_t>(channel::kWheelCommand, [this](const wheel_command_t& m) {
    check(channel::kWheelCommand, localization_.add_wheel_command(wheel_command_from(m)));
  });
}

void LocalizationNode::subscribe() {
  node_.subscribe<vo_motion_t>(channel::kVo, [this](const vo_motion_t& m) {
    check(channel::kVo, localization_.add_visual_motion(visual_from(m)));
  });
  node_.subscribe<ground_command_t>(channel::kGroundCommand,
                                    [this](const ground_command_t& m) { on_ground_command(m); });
  node_.subscribe<slam_pose_t>(channel::kSlamPose, [this](const slam_pose_t& m) {
    if (m.status == slam_pose_t::OK) check(channel::kSlamPose, localization_.add_slam_pose(measurement_from(m)));
  });
  node_.subscribe<correction_t>(channel::kCorrection, [this](const correction_t& m) {
    if (!m.accepted) return;
    const std::string_view rejection = localization_.apply_correction(measurement_from(m));
    check(channel::kCorrection, rejection);
    told_ = told_ || rejection.empty();
  });
}

void LocalizationNode::on_ground_command(const ground_command_t& command) {
  if (command.kind != ground_command_t::SET_START_POSE) return;
  const std::string_view rejection = localization_.set_start_pose(start_pose_from(command));
  told_ = told_ || rejection.empty();
  command_ack_t ack{};
  ack.command_id = command.command_id;
  ack.accepted = rejection.empty() ? 1 : 0;
  ack.reason = std::string(rejection);
  node_.publish(channel::kCommandAck, ack, node_.now());
  node_.log(rejection.empty() ? "INFO" : "WARN",
            "START_POSE accepted=" + std::to_string(ack.accepted) + " reason=" + ack.reason);
}

void LocalizationNode::on_step(Utime now) {
  checkpoint_.publish_restored();
  localization_.step(now);
  publish();
  report_status();
  save();
}

void LocalizationNode::publish() {
  const PoseEstimate& pose = localization_.pose();
  const Utime utime = pose.utime == kNever ? node_.now() : pose.utime;
  pose_t pose_message{};
  pose_to(pose, pose_message);
  node_.publish(channel::kPose, pose_message, utime);
  if (node_.now() < next_slip_) return;
  next_slip_ = node_.now() + kSlipPeriodUs;
  slip_t slip_message{};
  slip_to(localization_.slip(), slip_message);
  node_.publish(channel::kSlip, slip_message, utime);
}

void LocalizationNode::report_status() {
  const PoseEstimate& pose = localization_.pose();
  if (pose.status == status_ && pose.reason == reason_) return;
  status_ = pose.status;
  reason_ = std::string(pose.reason);
  const bool ok = status_ == PoseStatus::kOk;
  node_.set_status(ok ? heartbeat_t::OK : heartbeat_t::DEGRADED, reason_);
  node_.log(ok ? "INFO" : "WARN", std::string("POSE_STATUS status=") + to_string(status_) + " reason=" + reason_);
}

void LocalizationNode::restore() {
  checkpoint_.restore([this](const CheckpointStore::Bytes& bytes) {
    const auto checkpoint = from_bytes(bytes);
    if (checkpoint) localization_.restore(*checkpoint);
    return checkpoint.has_value();
  });
}

void LocalizationNode::save() {
  if (!checkpoint_.due() && !told_) return;
  told_ = false;
  if (const auto checkpoint = localization_.checkpoint()) checkpoint_.save(to_bytes(*checkpoint));
}

void LocalizationNode::check(const char* channel, std::string_view rejection) {
  if (!rejection.empty()) node_.reject(channel, std::string(rejection));
}

}  // namespace rover::loc
