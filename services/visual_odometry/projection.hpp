// Projection of a point in camera axes into a rectified stereo pair.
#pragma once

#include <Eigen/Core>

#include "common/core/image.hpp"

namespace rover::vo {

// (u_left, v, u_right). The point must lie in front of the camera.
Eigen::Vector3d project(const StereoCamera& camera, const Eigen::Vector3d& p_cam);

// Derivative of project() by the point.
Eigen::Matrix3d project_jacobian(const StereoCamera& camera, const Eigen::Vector3d& p_cam);

// Nearer points are ignored.
constexpr double kMinDepthM = 0.05;

}  // namespace rover::vo
