#include "slam/node.hpp"

#include "slam/convert.hpp"

namespace rover::slam {

SlamNode::SlamNode(Node& node, const NodeConfig& config)
    : node_(node), checkpoint_(node), slam_(config.core), growth_(node.options().cpu_scale) {
  node_.subscribe<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& m) { on_state(m); });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& m) { on_pose(m); });
  node_.subscribe_slow<cloud_t>(channel::kCloud, config.latency_us, [this](const cloud_t& m) { on_cloud(m); });
  node_.on_step([this](Utime) {
    checkpoint_.publish_restored();
    if (unsaved_ && checkpoint_.due()) unsaved_ = !checkpoint_.save(slam_.save());
  });
  checkpoint_.restore([this](const CheckpointStore::Bytes& bytes) {
    const bool restored = slam_.restore(bytes);
    if (restored) growth_.restore(slam_.odometry());
    return restored;
  });
}

void SlamNode::on_state(const supervisor_state_t& message) {
  const bool full = message.level == supervisor_state_t::FULL;
  if (full != full_level_) node_.log("INFO", full ? "LEVEL full: mapping" : "LEVEL efficient: idle");
  full_level_ = full;
}

void SlamNode::on_pose(const pose_t& message) {
  if (message.status == pose_t::UNINITIALISED) return;
  if (!usable(message)) return node_.reject(channel::kPose, "not finite");
  PoseSample sample = sample_from(message);
  growth_.add(message, sample.odometry);
  poses_.add(sample);
  if (!slam_.add_pose(sample.utime, sample.T_map_odom, sample.odometry.T_odom_body)) return;
  unsaved_ = true;
  node_.log("INFO", "ANCHOR map was moved against odom by a correction");
}

void SlamNode::on_cloud(const cloud_t& message) {
  if (!full_level_) return;
  if (const std::string fault = fault_of(message); !fault.empty()) return reject_cloud(fault);
  if (message.header.utime > node_.now()) return reject_cloud("of the future");
  const auto odometry = poses_.at(message.header.utime);
  if (!odometry) return reject_cloud("no POSE of its time");
  const SlamResult result = slam_.step(cloud_from(message), *odometry);
  if (!result.rejection.empty()) return reject_cloud(std::string(result.rejection));
  unsaved_ = true;
  publish(result, message.header.utime);
  report_status(result.status);
}

void SlamNode::reject_cloud(const std::string& why) {
  node_.reject(channel::kCloud, why);
  node_.set_status(heartbeat_t::DEGRADED, "cloud refused: " + why);
  last_status_ = Status::kLost;
}

void SlamNode::publish(const SlamResult& result, Utime utime) {
  // The map without this cloud would be old data with a fresh time.
  if (result.inserted) {
    elevation_t elevation{};
    elevation_to(slam_.elevation(), elevation);
    node_.publish(channel::kElevation, elevation, utime);
  }
  slam_pose_t pose{};
  slam_pose_to(result, pose);
  node_.publish(channel::kSlamPose, pose, utime);
}

void SlamNode::report_status(Status status) {
  if (status == last_status_) return;
  last_status_ = status;
  static constexpr const char* kNames[] = {"OK", "NO_INFORMATION", "LOST"};
  const bool lost = status == Status::kLost;
  node_.set_status(lost ? heartbeat_t::DEGRADED : heartbeat_t::OK, lost ? "cloud and map do not fit" : "");
  node_.log(lost ? "WARN" : "INFO", std::string("SLAM ") + kNames[static_cast<int>(status)]);
}

std::shared_ptr<SlamNode> make_slam(Node& node, const std::string& config_dir) {
  return std::make_shared<SlamNode>(node, load_config(config_dir));
}

}  // namespace rover::slam
