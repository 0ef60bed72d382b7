#include "@NAME@/node.hpp"

#include <rover/@NAME@_t.hpp>

#include "common/bus/convert.hpp"

namespace rover::@NAME@ {

@CLASS@Node::@CLASS@Node(Node& node, const NodeConfig& config) : node_(node), config_(config), core_(config.core) {
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& message) { on_pose(message); });
  node_.on_step([this](Utime) { report_status(); });
}

void @CLASS@Node::on_pose(const pose_t& message) {
  if (message.status == pose_t::UNINITIALISED) return;
  const Eigen::Isometry3d T_odom_body = pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz);
  if (!is_finite(T_odom_body)) return node_.reject(channel::kPose, "not finite");
  @NAME@_t out{};
  out.distance_m = core_.step(T_odom_body.translation());
  node_.publish(channel::k@CLASS@, out, message.header.utime);
}

void @CLASS@Node::report_status() {
  const bool fresh = node_.age_s(channel::kPose) <= config_.max_pose_age_s;
  if (fresh == pose_fresh_) return;
  pose_fresh_ = fresh;
  node_.set_status(fresh ? heartbeat_t::OK : heartbeat_t::DEGRADED, fresh ? "" : "no fresh POSE");
  node_.log(fresh ? "INFO" : "WARN", fresh ? "POSE_FRESH" : "POSE_STALE");
}

std::shared_ptr<@CLASS@Node> make_@NAME@(Node& node, const std::string& config_dir) {
  return std::make_shared<@CLASS@Node>(node, load_config(config_dir));
}

}  // namespace rover::@NAME@
