// Bus node: PTU_COMMAND with an image request whenever a view is due at the Full level.
#pragma once

#include <memory>
#include <string>

#include "common/bus/node.hpp"
#include "pan_tilt/config.hpp"

namespace rover::gaze {

class PanTiltNode {
 public:
  PanTiltNode(Node& node, const NodeConfig& config);
  PanTiltNode(const PanTiltNode&) = delete;
  PanTiltNode& operator=(const PanTiltNode&) = delete;

 private:
  void step(Utime now);
  void report_status();

  Node& node_;
  NodeConfig config_;
  PanTilt core_;
  Task task_ = Task::kIdle;
  Task reported_task_ = Task::kIdle;
  bool unit_timed_out_ = false;
};

std::shared_ptr<PanTiltNode> make_pan_tilt(Node& node, const std::string& config_dir);

}  // namespace rover::gaze
