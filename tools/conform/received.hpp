// Messages received from a driver, in order of arrival.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/core/image.hpp"
#include "common/core/time.hpp"

namespace rover::conform {

// Times and source of a message, by its header and by this machine.
struct Stamp {
  double arrival_s = 0.0;  // by this machine's clock
  Utime tick = kNever;     // newest TICK at arrival
  Utime utime = 0;
  Utime release = 0;
  std::int64_t seq = 0;
  std::string publisher;
  std::int64_t boot_id = 0;
};

struct ReceivedTick {
  Stamp stamp;
  bool by_the_clock = false;
};

struct ReceivedImu {
  Stamp stamp;
  double dt_s = 0.0;
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d delta_velocity_mps = Eigen::Vector3d::Zero();
  double fog_delta_yaw_rad = 0.0;
  bool ok = true;
};

struct ReceivedWheels {
  Stamp stamp;
  std::array<double, 6> angle_rad{};
  std::array<double, 6> rate_radps{};
  std::array<double, 4> steer_rad{};
  bool finite = true;  // all numbers of the message are finite
  bool fault = false;
  bool command_expired = false;
};

struct ReceivedImage {
  Stamp stamp;
  int width = 0;
  int height = 0;
  bool mono8 = true;
  int bytes = 0;
  GrayImage image;  // stored for a few images, empty otherwise
};

struct Received {
  std::vector<ReceivedTick> ticks;
  std::vector<ReceivedImu> imu;
  std::vector<ReceivedWheels> wheels;
  std::vector<ReceivedImage> left;
  std::vector<ReceivedImage> right;
  std::map<std::string, int> malformed;  // by channel
  bool stack = false;                    // services of the rover publish on this bus too
};

}  // namespace rover::conform
