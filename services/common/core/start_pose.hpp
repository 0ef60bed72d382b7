// What a start pose of the ground must satisfy, so that all services refuse the same ones.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "common/core/frames.hpp"

namespace rover {

constexpr double kMaxMapPositionM = 1e6;

// Why it cannot be one; empty if it can. In map; standard deviations of each axis and of the yaw.
inline std::string_view start_pose_problem(const Eigen::Vector3d& position_m, double yaw_rad, double sigma_m,
                                           double sigma_yaw_rad) {
  if (!position_m.allFinite() || !std::isfinite(yaw_rad)) return "start pose not finite";
  if (position_m.cwiseAbs().maxCoeff() > kMaxMapPositionM) return "start position out of range";
  if (!(sigma_m > 0.0 && sigma_m < 1000.0)) return "sigma_m out of range";
  if (!(sigma_yaw_rad > 0.0 && sigma_yaw_rad <= kPi)) return "sigma_yaw_rad out of range";
  return {};
}

}  // namespace rover
