// LCM node: publishes one HAZARDS for each DISPARITY that it works on, in every state of the rover.
#pragma once

#include <memory>
#include <rover/disparity_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <string>

#include "common/bus/node.hpp"
#include "hazard_detector/config.hpp"
#include "hazard_detector/hazard_detector.hpp"

namespace rover::hazard {

class HazardNode {
 public:
  HazardNode(Node& node, const NodeConfig& config);
  HazardNode(const HazardNode&) = delete;
  HazardNode& operator=(const HazardNode&) = delete;

 private:
  void on_visual_motion(const vo_motion_t& message);
  void on_disparity(const disparity_t& message);
  void report(const HazardResult& result);

  Node& node_;
  HazardDetector core_;
  std::string doubt_;   // why disparities are not believed; empty: they are
  std::string reason_;  // of the last BLIND; empty: it was none
  Status last_status_ = Status::kClear;
};

std::shared_ptr<HazardNode> make_hazard_detector(Node& node, const std::string& config_dir);

}  // namespace rover::hazard
