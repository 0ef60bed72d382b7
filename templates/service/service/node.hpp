// Bus node: one @CHANNEL@ per valid POSE.
#pragma once

#include <memory>
#include <rover/pose_t.hpp>
#include <string>

#include "@NAME@/config.hpp"
#include "common/bus/node.hpp"

namespace rover::@NAME@ {

class @CLASS@Node {
 public:
  @CLASS@Node(Node& node, const NodeConfig& config);
  @CLASS@Node(const @CLASS@Node&) = delete;
  @CLASS@Node& operator=(const @CLASS@Node&) = delete;

 private:
  void on_pose(const pose_t& message);
  void report_status();

  Node& node_;
  NodeConfig config_;
  @CLASS@ core_;
  bool pose_fresh_ = true;  // as last reported
};

std::shared_ptr<@CLASS@Node> make_@NAME@(Node& node, const std::string& config_dir);

}  // namespace rover::@NAME@
