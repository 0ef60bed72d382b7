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
                                    [this](const elevation_t& message) { on_elevation(message); });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& message) { pose_ = message; });
}

void TraversabilityNode::on_elevation(const elevation_t& message) {
  const std::string rejection = rejection_of(message);
  if (!rejection.empty()) {
    node_.reject(channel::kElevation, rejection);
    return;
  }
  last_map_utime_ = message.header.utime;
  const TraversabilityMap map = compute_traversability(grid_from(message), config_.core);
  const double difficulty = difficulty_ahead(map, fresh_pose(), config_.core.ahead);
  traversability_t out{};
  traversability_to(map, difficulty, out);
  node_.publish(channel::kTraversability, out, message.header.utime);
  report_status(difficulty);
}

std::string TraversabilityNode::rejection_of(const elevation_t& message) const {
  const double age_s = to_seconds(node_.now() - message.header.utime);
  if (age_s < 0.0) return "from the future";
  if (age_s > config_.max_map_age_s * node_.options().cpu_scale) return "stale";
  if (message.header.utime <= last_map_utime_) return "not newer than the last map";
  return fault_of(message);
}

// NaN if the newest pose is stale.
Pose2 TraversabilityNode::fresh_pose() const {
  const double age_s = to_seconds(node_.now() - pose_.header.utime);
  const bool fresh = pose_.header.utime != kNever && age_s >= 0.0 && age_s <= config_.max_pose_age_s;
  return fresh ? body_from(pose_) : Pose2{kNaN, kNaN, kNaN};
}

void TraversabilityNode::report_status(double difficulty) {
  const bool difficulty_known = !std::isnan(difficulty);
  if (difficulty_known == difficulty_known_) return;
  difficulty_known_ = difficulty_known;
  node_.set_status(difficulty_known ? heartbeat_t::OK : heartbeat_t::DEGRADED,
                   difficulty_known ? "" : "too little ground known ahead");
  node_.log(difficulty_known ? "INFO" : "WARN",
            difficulty_known ? "GROUND_AHEAD difficulty=" + std::to_string(difficulty) : "GROUND_AHEAD_UNKNOWN");
}

std::shared_ptr<TraversabilityNode> make_traversability(Node& node, const std::string& config_dir) {
  return std::make_shared<TraversabilityNode>(node, load_config(config_dir));
}

}  // namespace rover::trav
