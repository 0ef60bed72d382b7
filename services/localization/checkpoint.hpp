// What localization needs to go on after its process died.
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
  Utime visual_newest = kNever;             // the newest visual motion used
  std::array<double, 6> drive_angle_rad{};  // NaN: no encoder reading
};

std::vector<std::uint8_t> to_bytes(const Checkpoint& checkpoint);
// Nothing where the bytes are no checkpoint of this version, or hold what no rover can have been in.
std::optional<Checkpoint> from_bytes(const std::vector<std::uint8_t>& bytes);

}  // namespace rover::loc
