// What was heard of a driver, in the order of arrival.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/core/image.hpp"
#include "common/core/time.hpp"

namespace rover::conform {

// Of every message: who said it when, by its own word and by ours.
struct Stamp {
  double arrival_s = 0.0;  // by this machine's clock
  Utime tick = kNever;     // the newest TICK that had come before it
  Utime utime = 0;
  Utime release = 0;
  std::int64_t seq = 0;
  std::string publisher;
  std::int64_t boot_id = 0;
};

struct TickHeard {
  Stamp stamp;
  bool by_the_clock = false;
};

struct ImuHeard {
  Stamp stamp;
  double dt_s = 0.0;
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d delta_velocity_mps = Eigen::Vector3d::Zero();
  double fog_delta_yaw_rad = 0.0;
  bool ok = true;
};

struct WheelsHeard {
  Stamp stamp;
  std::array<double, 6> angle_rad{};
  std::array<double, 6> rate_radps{};
  std::array<double, 4> steer_rad{};
  bool finite = true;  // every number of the message
  bool fault = false;
  bool command_expired = false;
};

struct ImageHeard {
  Stamp stamp;
  int width = 0;
  int height = 0;
  bool mono8 = true;
  int bytes = 0;
  GrayImage image;  // kept of some, empty otherwise
};

struct Heard {
  std::vector<TickHeard> ticks;
  std::vector<ImuHeard> imu;
  std::vector<WheelsHeard> wheels;
  std::vector<ImageHeard> left;
  std::vector<ImageHeard> right;
  std::map<std::string, int> malformed;  // by channel
  bool stack = false;                    // services of the rover speak on this bus too
};

}  // namespace rover::conform
