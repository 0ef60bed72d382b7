#include "pan_tilt/node.hpp"

#include "pan_tilt/convert.hpp"

namespace rover::gaze {

PanTiltNode::PanTiltNode(Node& node, const NodeConfig& config)
    : node_(node), config_(config), core_(config.core, config.unit, config.mount) {
  const auto handle = [this](const char* channel, auto input, auto use) {
    if (!input) return node_.reject(channel, "not usable");
    use(std::move(*input));
  };
  node_.subscribe<path_t>(channel::kPath, [this, handle](const path_t& message) {
    handle(channel::kPath, path_from(message), [this](Path path) { core_.set_path(std::move(path)); });
  });
  // A LOST pose is a valid message: ignored, not rejected.
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& message) {
    if (const auto pose = pose_from(message)) core_.set_pose(*pose);
  });
  node_.subscribe<ptu_state_t>(channel::kPtuState, [this, handle](const ptu_state_t& message) {
    handle(channel::kPtuState, unit_from(message), [this](const UnitState& unit) { core_.set_unit_state(unit); });
  });
  node_.subscribe<supervisor_state_t>(channel::kState,
                                      [this](const supervisor_state_t& message) { task_ = task_of(message); });
  node_.on_step([this](Utime now) { step(now); });
}

void PanTiltNode::step(Utime now) {
  const bool state_fresh = node_.age_s(channel::kState) <= config_.max_state_age_s;
  if (const auto gaze = core_.step(now, state_fresh ? task_ : Task::kIdle)) {
    ptu_command_t command = command_of(*gaze);
    node_.publish(channel::kPtuCommand, command, now);
  }
  report_status();
}

void PanTiltNode::report_status() {
  static constexpr const char* kTasks[] = {"IDLE", "AHEAD", "SWEEP", "STUCK"};
  if (task_ != reported_task_) node_.log("INFO", std::string("TASK ") + kTasks[static_cast<int>(task_)]);
  reported_task_ = task_;
  if (core_.unit_timed_out() == unit_timed_out_) return;
  unit_timed_out_ = core_.unit_timed_out();
  node_.set_status(unit_timed_out_ ? heartbeat_t::DEGRADED : heartbeat_t::OK,
                   unit_timed_out_ ? "the unit does not come" : "");
  node_.log(unit_timed_out_ ? "WARN" : "INFO", unit_timed_out_ ? "UNIT_FAILS" : "UNIT_BACK");
}

std::shared_ptr<PanTiltNode> make_pan_tilt(Node& node, const std::string& config_dir) {
  return std::make_shared<PanTiltNode>(node, load_config(config_dir));
}

}  // namespace rover::gaze
