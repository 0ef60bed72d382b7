// LCM node: subscribes to MOTION_COMMAND, DRIVE_PERMIT, WHEEL_STATE; publishes WHEEL_COMMAND each tick.
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
  bool steering_lagging_ = false;
};

}  // namespace rover::locomotion
