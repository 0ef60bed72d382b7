// Projection into a rectified stereo pair: a point in camera axes gives (u, v) in the left and u in the right image.
#pragma once

#include <Eigen/Core>

#include "common/core/image.hpp"

namespace rover::vo {

// (u_left, v, u_right). The point must lie in front of the camera.
Eigen::Vector3d project(const StereoCamera& camera, const Eigen::Vector3d& p_cam);

// Derivative of project() by the point.
Eigen::Matrix3d project_jacobian(const StereoCamera& camera, const Eigen::Vector3d& p_cam);

// Points nearer than this are not looked at: [m].
constexpr double kMinDepthM = 0.05;

}  // namespace rover::vo
