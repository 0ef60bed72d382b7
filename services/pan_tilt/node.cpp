#include "pan_tilt/node.hpp"

#include "pan_tilt/convert.hpp"

namespace rover::gaze {

PanTiltNode::PanTiltNode(Node& node, const NodeConfig& config)
    : node_(node), config_(config), core_(config.core, config.unit, config.mount) {
  const auto take = [this](const char* channel, auto input, auto use) {
    if (!input) return node_.reject(channel, "not usable");
    use(std::move(*input));
  };
  node_.subscribe<path_t>(channel::kPath, [this, take](const path_t& message) {
    take(channel::kPath, path_from(message), [this](Path path) { core_.take_path(std::move(path)); });
  });
  // A pose that says itself that it is lost is no fault of the message.
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& message) {
    if (const auto pose = pose_from(message)) core_.take_pose(*pose);
  });
  node_.subscribe<ptu_state_t>(channel::kPtuState, [this, take](const ptu_state_t& message) {
    take(channel::kPtuState, unit_from(message), [this](const UnitState& unit) { core_.take_unit(unit); });
  });
  node_.subscribe<supervisor_state_t>(channel::kState,
                                      [this](const supervisor_state_t& message) { task_ = task_of(message); });
  node_.on_step([this](Utime now) { step(now); });
}

void PanTiltNode::step(Utime now) {
  const bool heard = node_.age_s(channel::kState) <= config_.max_state_age_s;
  if (const auto gaze = core_.step(now, heard ? task_ : Task::kIdle)) {
    ptu_command_t command = command_of(*gaze);
    node_.publish(channel::kPtuCommand, command, now);
  }
  report();
}

void PanTiltNode::report() {
  static constexpr const char* kTasks[] = {"IDLE", "AHEAD", "SWEEP", "STUCK"};
  if (task_ != reported_) node_.log("INFO", std::string("TASK ") + kTasks[static_cast<int>(task_)]);
  reported_ = task_;
  if (core_.unit_fails() == unit_fails_) return;
  unit_fails_ = core_.unit_fails();
  node_.set_status(unit_fails_ ? heartbeat_t::DEGRADED : heartbeat_t::OK, unit_fails_ ? "the unit does not come" : "");
  node_.log(unit_fails_ ? "WARN" : "INFO", unit_fails_ ? "UNIT_FAILS" : "UNIT_BACK");
}

std::shared_ptr<PanTiltNode> make_pan_tilt(Node& node, const std::string& config_dir) {
  return std::make_shared<PanTiltNode>(node, load_config(config_dir));
}

}  // namespace rover::gaze
