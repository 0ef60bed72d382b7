#include "slam/node.hpp"

#include "slam/convert.hpp"

namespace rover::slam {
namespace {

constexpr Utime kFreshVo = 800'000;  // a frame each 0.4 s, told 0.3 s later: older ones mean that one is missing

}  // namespace

double BlindWay::add(const pose_t& pose) {
  const double way_m = pose.travelled_m - travelled_m_;  // NaN at first
  travelled_m_ = pose.travelled_m;
  const bool blind = pose.last_vo_utime < 0 || pose.header.utime - pose.last_vo_utime > kFreshVo;
  if (blind && way_m > 0.0) way_m_ += way_m;
  return way_m_;
}

SlamNode::SlamNode(Node& node, const NodeConfig& config) : node_(node), kept_(node), slam_(config.core) {
  node_.subscribe<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& m) { take_state(m); });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& m) { take_pose(m); });
  node_.subscribe_slow<cloud_t>(channel::kCloud, config.latency_us, [this](const cloud_t& m) { take_cloud(m); });
  node_.on_step([this](Utime) {
    kept_.tell();
    if (unsaved_ && kept_.due()) unsaved_ = !kept_.save(slam_.save());
  });
  kept_.restore([this](const KeptState::Bytes& bytes) { return slam_.restore(bytes); });
}

void SlamNode::take_state(const supervisor_state_t& message) {
  const bool full = message.level == supervisor_state_t::FULL;
  if (full != full_) node_.log("INFO", full ? "LEVEL full: mapping" : "LEVEL efficient: idle");
  full_ = full;
}

void SlamNode::take_pose(const pose_t& message) {
  if (message.status == pose_t::UNINITIALISED) return;
  if (!usable(message)) return node_.reject(channel::kPose, "not finite");
  PoseSample sample = sample_from(message);
  sample.odometry.blind_way_m = blind_way_.add(message);
  poses_.add(sample);
  if (slam_.take_pose(sample.utime, sample.T_map_odom, sample.odometry.T_odom_body))
    node_.log("INFO", "ANCHOR map was moved against odom by a correction");
}

void SlamNode::take_cloud(const cloud_t& message) {
  if (!full_) return;
  if (const std::string fault = fault_of(message); !fault.empty()) return refuse(fault);
  if (message.header.utime > node_.now()) return refuse("of the future");
  const auto odometry = poses_.at(message.header.utime);
  if (!odometry) return refuse("no POSE of its time");
  const SlamResult result = slam_.step(cloud_from(message), *odometry);
  if (!result.refusal.empty()) return refuse(std::string(result.refusal));
  unsaved_ = true;
  publish(result, message.header.utime);
  report(result.status);
}

void SlamNode::refuse(const std::string& why) {
  node_.reject(channel::kCloud, why);
  node_.set_status(heartbeat_t::DEGRADED, "cloud refused: " + why);
  last_ = Status::kLost;
}

void SlamNode::publish(const SlamResult& result, Utime utime) {
  elevation_t elevation{};
  elevation_to(slam_.elevation(), elevation);
  node_.publish(channel::kElevation, elevation, utime);
  slam_pose_t pose{};
  slam_pose_to(result, pose);
  node_.publish(channel::kSlamPose, pose, utime);
}

void SlamNode::report(Status status) {
  if (status == last_) return;
  last_ = status;
  static constexpr const char* kNames[] = {"OK", "NO_INFORMATION", "LOST"};
  const bool lost = status == Status::kLost;
  node_.set_status(lost ? heartbeat_t::DEGRADED : heartbeat_t::OK, lost ? "cloud and map do not fit" : "");
  node_.log(lost ? "WARN" : "INFO", std::string("SLAM ") + kNames[static_cast<int>(status)]);
}

std::shared_ptr<SlamNode> make_slam(Node& node, const std::string& config_dir) {
  return std::make_shared<SlamNode>(node, load_config(config_dir));
}

}  // namespace rover::slam
