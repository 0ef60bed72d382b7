// The bus side of the pan-tilt unit: PTU_COMMAND with a picture, whenever one is due at the Full level.
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
  void report();

  Node& node_;
  NodeConfig config_;
  PanTilt core_;
  Task task_ = Task::kIdle;
  Task reported_ = Task::kIdle;
  bool unit_fails_ = false;
};

std::shared_ptr<PanTiltNode> make_pan_tilt(Node& node, const std::string& config_dir);

}  // namespace rover::gaze
