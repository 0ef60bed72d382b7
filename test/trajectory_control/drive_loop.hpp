// Closed loop of trajectory control, locomotion and a kinematic rover. Messages are used one tick after publication,
// wheel states at once.
#pragma once

#include <functional>
#include <vector>

#include "common/bus/vehicle_config.hpp"
#include "locomotion/config.hpp"
#include "locomotion/locomotion.hpp"
#include "test/trajectory_control/kinematic_rover.hpp"
#include "trajectory_control/config.hpp"
#include "trajectory_control/trajectory_controller.hpp"

namespace rover::test {

inline const char* config_dir() {
  return ROVER_SOURCE_DIR "/config";
}

// An arc of a polyline.
struct ArcPiece {
  double curvature_per_m;
  double length_m;
};

inline std::vector<Eigen::Vector2d> polyline(const std::vector<ArcPiece>& pieces, double step_m = 0.1,
                                             Pose2 start = {}) {
  std::vector<Eigen::Vector2d> out = {{start.x_m, start.y_m}};
  Pose2 p = start;
  for (const ArcPiece& piece : pieces) {
    const int count = std::max(1, static_cast<int>(std::lround(piece.length_m / step_m)));
    const double ds = piece.length_m / count;
    for (int i = 0; i < count; ++i) {
      const double mid_yaw_rad = p.yaw_rad + 0.5 * ds * piece.curvature_per_m;
      p.x_m += ds * std::cos(mid_yaw_rad);
      p.y_m += ds * std::sin(mid_yaw_rad);
      p.yaw_rad += ds * piece.curvature_per_m;
      out.emplace_back(p.x_m, p.y_m);
    }
  }
  return out;
}

// A detour around an obstacle back onto the line: radius 1.25 m, about 0.9 m to the side.
inline void append_repair(std::vector<ArcPiece>& pieces, double side) {
  const double k = side * 0.8;
  const double arc_m = to_rad(45.0) / 0.8;
  for (const ArcPiece& p : {ArcPiece{k, arc_m}, ArcPiece{-k, arc_m}, ArcPiece{0.0, 1.0}, ArcPiece{-k, arc_m},
                            ArcPiece{k, arc_m}, ArcPiece{0.0, 4.0}})
    pieces.push_back(p);
}

// 86 m with six detours and wide bends between them.
inline std::vector<ArcPiece> seed_traverse() {
  std::vector<ArcPiece> pieces = {{0.0, 4.0}};
  for (int i = 0; i < 6; ++i) {
    append_repair(pieces, i % 2 == 0 ? 1.0 : -1.0);
    pieces.push_back({i % 2 == 0 ? 0.15 : -0.2, 4.0});
  }
  double length = 0.0;
  for (const ArcPiece& p : pieces) length += p.length_m;
  pieces.push_back({0.0, 86.0 - length});
  return pieces;
}

class DriveLoop {
 public:
  explicit DriveLoop(const control::TrajectoryControlConfig& control_config = control::load_config(config_dir()),
                     const locomotion::NodeConfig& wheels_config = locomotion::load_config(config_dir()))
      : config(control_config),
        controller(config),
        locomotion_config(wheels_config),
        wheels(locomotion_config.locomotion, locomotion_config.vehicle),
        rover(locomotion_config.vehicle) {}

  void tick() {
    now += kTickUs;
    rover.step(applied_, to_seconds(kTickUs));
    const locomotion::WheelReading reading{now, rover.wheels().steer_angle_rad, false, false};
    const locomotion::WheelCommand wheel_command = wheels.step(now, command_, permit_, reading);
    const control::ControlOutput control_output = controller.step(now, pose_, permit_);

    // Outputs of this tick are used at the next one.
    const bool wheel_command_valid = wheel_command.valid;
    applied_ = wheel_command_valid ? wheel_command.wheels : stopped(applied_);
    command_ = control_output.command;
    output = control_output;
    wheel_output = wheel_command;
    if (pose_alive) pose_ = {now, true, rover.pose(), rover.twist().forward_mps, rover.twist().left_mps};
    if (modify_pose) modify_pose(pose_);
    if (permit_alive) permit_ = {now, permitted ? now + to_utime(0.2) : now, permitted, max_speed_mps};
    if (!control_alive) command_ = last_command_;
    last_command_ = command_;
  }

  void run(double seconds) {
    for (Utime end = now + to_utime(seconds); now < end;) tick();
  }

  double speed() const { return std::hypot(rover.twist().forward_mps, rover.twist().left_mps); }

  control::TrajectoryControlConfig config;
  control::TrajectoryController controller;
  locomotion::NodeConfig locomotion_config;
  locomotion::Locomotion wheels;
  KinematicRover rover;
  control::ControlOutput output;
  locomotion::WheelCommand wheel_output;
  Utime now = 0;
  bool permitted = true;
  bool permit_alive = true;
  bool pose_alive = true;
  bool control_alive = true;
  double max_speed_mps = 0.2;
  std::function<void(control::PoseInput&)> modify_pose;

 private:
  static WheelSetpoints stopped(WheelSetpoints wheels) {
    wheels.drive_rate_radps.fill(0.0);
    return wheels;
  }

  WheelSetpoints applied_;
  MotionCommand command_;
  MotionCommand last_command_;
  DrivePermit permit_;
  control::PoseInput pose_;
};

}  // namespace rover::test
