#include "path_planner/map/view_area.hpp"

namespace rover::planning {
namespace {

constexpr double kBlockPx = 5.0;  // half a block of the disparity: nearer to the rim of a picture there is none
constexpr double kStepM = 0.005;
constexpr double kHalfCellM = 0.05;  // ground counts as seen where the far half of a cell is

// Whether both cameras see the point of the ground, in body axes.
bool sees(const StereoRig& rig, const Eigen::Vector3d& ground) {
  const auto in_picture = [&](const PinholeCamera& camera, const Eigen::Isometry3d& T_body_camera) {
    const Eigen::Vector3d p = T_body_camera.inverse() * ground;
    const double x_px = camera.cx_px + camera.fx_px * p.x() / p.z();
    const double y_px = camera.cy_px + camera.fy_px * p.y() / p.z();
    return p.z() > 0.0 && x_px >= kBlockPx && x_px < rig.width - kBlockPx && y_px >= kBlockPx &&
           y_px < rig.height - kBlockPx;
  };
  return in_picture(rig.left, rig.T_body_left) && in_picture(rig.right, rig.T_body_left * rig.T_left_right);
}

}  // namespace

ViewArea view_of(const StereoRig& rig, double ground_z_m, double far_m) {
  const Eigen::Vector3d camera = rig.T_body_left.translation();
  const auto half_width_m = [&](double x_m) {
    double y_m = 0.0;
    while (sees(rig, {x_m, y_m, ground_z_m}) && sees(rig, {x_m, -y_m, ground_z_m})) y_m += kStepM;
    return y_m - kStepM;
  };
  double near_m = camera.x();
  while (near_m < far_m && !sees(rig, {near_m, 0.0, ground_z_m})) near_m += kStepM;
  return {{camera.x(), camera.y()}, near_m - kHalfCellM, far_m, half_width_m(near_m), half_width_m(far_m)};
}

}  // namespace rover::planning
