#include "hazard_detector/node.hpp"

#include <algorithm>
#include <rover/hazards_t.hpp>

#include "common/bus/convert.hpp"
#include "hazard_detector/convert.hpp"

namespace rover::hazard {

HazardNode::HazardNode(Node& node, const NodeConfig& config) : node_(node), core_(config.core) {
  if (node.options().boot_id > 1) doubt_ = "no VO yet";  // the predecessor may have known that they are wrong
  node_.subscribe<vo_motion_t>(channel::kVo, [this](const vo_motion_t& message) { on_visual_motion(message); });
  node_.subscribe_slow<disparity_t>(channel::kDisparity, config.latency_us,
                                    [this](const disparity_t& message) { on_disparity(message); });
}

void HazardNode::on_visual_motion(const vo_motion_t& message) {
  doubt_ = message.status == vo_motion_t::DISPLACED ? "LocCam displaced" : "";
}

void HazardNode::on_disparity(const disparity_t& message) {
  const std::string error = validation_error(message);
  if (!error.empty()) {
    node_.reject(channel::kDisparity, error);
    return;
  }
  Disparity disparity = disparity_from(message);
  if (!doubt_.empty()) std::fill(disparity.px16.begin(), disparity.px16.end(), Disparity::kInvalid);
  const HazardResult result = core_.step(disparity, camera_from(message));
  hazards_t hazards{};
  hazards_to(result, core_.shape(), hazards);
  node_.publish(channel::kHazards, hazards, message.header.utime);
  report(result);
}

void HazardNode::report(const HazardResult& result) {
  const bool blind = result.status == Status::kBlind;
  const std::string reason = !blind ? "" : doubt_.empty() ? "too little stereo" : doubt_;
  if (result.status == last_status_ && reason == reason_) return;
  last_status_ = result.status;
  reason_ = reason;
  node_.set_status(blind ? heartbeat_t::DEGRADED : heartbeat_t::OK, reason);
  static constexpr const char* kNames[] = {"CLEAR", "HAZARD", "BLIND"};
  node_.log(blind ? "WARN" : "INFO", std::string(kNames[static_cast<int>(result.status)]) +
                                         " coverage=" + std::to_string(result.coverage) +
                                         " nearest_m=" + std::to_string(result.nearest_hazard_m));
}

std::shared_ptr<HazardNode> make_hazard_detector(Node& node, const std::string& config_dir) {
  return std::make_shared<HazardNode>(node, load_config(config_dir));
}

}  // namespace rover::hazard
