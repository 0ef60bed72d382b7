// Locomotion on the bus: MOTION_COMMAND, DRIVE_PERMIT and WHEEL_STATE in, WHEEL_COMMAND out each tick.
#pragma once

#include "common/bus/node.hpp"
#include "locomotion/config.hpp"
#include "locomotion/locomotion.hpp"

namespace rover::locomotion {

class LocomotionNode {
 public:
  LocomotionNode(Node& node, const NodeConfig& config);

 private:
  void step(Utime now);
  void stop();
  void report(const WheelCommand& command);

  Node& node_;
  Utime validity_;
  double steering_slow_rad_;
  Locomotion locomotion_;
  MotionCommand command_;
  DrivePermit permit_;
  WheelReading wheels_;
  LocomotionState state_ = LocomotionState::kHolding;
  bool steering_late_ = false;
};

}  // namespace rover::locomotion
