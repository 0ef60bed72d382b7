// State that localization needs to continue after a restart of its process.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "localization/filter.hpp"

namespace rover::loc {

struct Checkpoint {
  Utime utime = kNever;
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();
  bool map_known = false;
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  ErrorCov P = ErrorCov::Zero();
  double gravity_mps2 = 0.0;
  double travelled_m = 0.0;
  Utime newest_visual_utime = kNever;       // of the newest visual motion fused
  std::array<double, 6> drive_angle_rad{};  // NaN without an encoder reading
};

std::vector<std::uint8_t> to_bytes(const Checkpoint& checkpoint);
// Empty if the bytes are of another version or the state is invalid.
std::optional<Checkpoint> from_bytes(const std::vector<std::uint8_t>& bytes);

}  // namespace rover::loc
