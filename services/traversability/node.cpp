#include "traversability/node.hpp"

#include <cmath>
#include <rover/traversability_t.hpp>

#include "common/bus/elevation_message.hpp"
#include "traversability/convert.hpp"
#include "traversability/difficulty.hpp"

namespace rover::trav {

TraversabilityNode::TraversabilityNode(Node& node, const NodeConfig& config) : node_(node), config_(config) {
  pose_.header.utime = kNever;
  node_.subscribe_slow<elevation_t>(channel::kElevation, config.latency_us,
                                    [this](const elevation_t& message) { take(message); });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& message) { pose_ = message; });
}

void TraversabilityNode::take(const elevation_t& message) {
  const std::string refusal = refusal_of(message);
  if (!refusal.empty()) {
    node_.reject(channel::kElevation, refusal);
    return;
  }
  last_map_ = message.header.utime;
  const TraversabilityMap map = judge_terrain(grid_from(message), config_.core);
  const double difficulty = difficulty_ahead(map, body(), config_.core.ahead);
  traversability_t out{};
  traversability_to(map, difficulty, out);
  node_.publish(channel::kTraversability, out, message.header.utime);
  report(difficulty);
}

std::string TraversabilityNode::refusal_of(const elevation_t& message) const {
  const double age_s = to_seconds(node_.now() - message.header.utime);
  if (age_s < 0.0) return "from the future";
  if (age_s > config_.max_map_age_s) return "stale";
  if (message.header.utime <= last_map_) return "not newer than the last map";
  return fault_of(message);
}

// NaN without a fresh pose.
Pose2 TraversabilityNode::body() const {
  const double age_s = to_seconds(node_.now() - pose_.header.utime);
  const bool fresh = pose_.header.utime != kNever && age_s >= 0.0 && age_s <= config_.max_pose_age_s;
  return fresh ? body_from(pose_) : Pose2{kNaN, kNaN, kNaN};
}

void TraversabilityNode::report(double difficulty) {
  const bool judged = !std::isnan(difficulty);
  if (judged == judged_) return;
  judged_ = judged;
  node_.set_status(judged ? heartbeat_t::OK : heartbeat_t::DEGRADED, judged ? "" : "too little ground known ahead");
  node_.log(judged ? "INFO" : "WARN",
            judged ? "GROUND_AHEAD difficulty=" + std::to_string(difficulty) : "GROUND_AHEAD_UNKNOWN");
}

std::shared_ptr<TraversabilityNode> make_traversability(Node& node, const std::string& config_dir) {
  return std::make_shared<TraversabilityNode>(node, load_config(config_dir));
}

}  // namespace rover::trav
