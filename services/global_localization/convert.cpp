#include "global_localization/convert.hpp"

#include <array>

#include "common/bus/convert.hpp"

namespace rover::global {
namespace {

// x, y, yaw among x y z roll pitch yaw.
constexpr std::array<int, 3> kPlanar = {0, 1, 5};

}  // namespace

ElevationView view_from(const elevation_t& message) {
  return {{message.cells_x, message.cells_y, message.cell_m, message.origin_x_m, message.origin_y_m},
          message.height_m,
          message.sigma_m,
          message.brightness};
}

std::optional<Prior> prior_from(const pose_t& message) {
  if (message.status != pose_t::OK && message.status != pose_t::DEGRADED) return std::nullopt;
  const Eigen::Isometry3d T_map_odom = pose_from(message.position_map_odom_m, message.quat_map_odom_wxyz);
  const Eigen::Isometry3d T_odom_body = pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz);
  if (!is_finite(T_map_odom) || !is_finite(T_odom_body) || !std::isfinite(message.travelled_m)) return std::nullopt;
  Prior prior;
  prior.T_map_odom = planar(T_map_odom);
  prior.p_odom_body = T_odom_body.translation().head<2>();
  const Matrix6d cov = matrix6_from(message.covariance);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) prior.cov(i, j) = cov(kPlanar[static_cast<size_t>(i)], kPlanar[static_cast<size_t>(j)]);
  return prior;
}

void correction_to(const Correction& correction, const Prior& prior, correction_t& message) {
  const Pose2& T = correction.accepted ? correction.T_map_odom : prior.T_map_odom;
  const Eigen::Matrix3d& cov = correction.accepted ? correction.cov : prior.cov;
  message.layer =
      static_cast<std::int8_t>(correction.layer == Layer::kPicture ? +correction_t::PICTURE : +correction_t::HEIGHT);
  message.accepted = correction.accepted ? 1 : 0;
  message.x_m = T.x_m;
  message.y_m = T.y_m;
  message.yaw_rad = T.yaw_rad;
  for (int i = 0; i < 9; ++i) message.covariance[i] = cov(i / 3, i % 3);
  message.score = correction.score;
  message.second_score = correction.second_score;
  message.reason = correction.reason;
  if (correction.reason.starts_with("ambiguous"))
    message.reason += " (" + std::to_string(correction.similar_places) + " places)";
  if (!correction.accepted && !correction.picture_reason.empty())
    message.reason += "; picture: " + std::string(correction.picture_reason);
}

}  // namespace rover::global
