#include "slam/match_error.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace rover::slam {
namespace {

constexpr double kGateSigma = 4.0;  // of the innovation; larger ones are outliers

}  // namespace

MatchError::MatchError(const MatchErrorConfig& config) : config_(config) {
  state_.bias_variance_m2 = config.bias_sigma_m * config.bias_sigma_m;
}

void MatchError::predict(double distance_m) {
  state_.bias_variance_m2 += config_.bias_m_rtm * config_.bias_m_rtm * distance_m;
}

void MatchError::update(const Eigen::Vector2d& fit_m, const Eigen::Matrix2d& covariance_m2, double pose_sigma_m) {
  const Eigen::Vector2d innovation(fit_m.x() - state_.bias.x_m, fit_m.y() - state_.bias.y_m);
  const double known_m2 = state_.bias_variance_m2 + pose_sigma_m * pose_sigma_m;
  const Eigen::Matrix2d expected = state_.scatter * covariance_m2 + known_m2 * Eigen::Matrix2d::Identity();
  if (!(innovation.dot(expected.inverse() * innovation) < kGateSigma * kGateSigma)) return;
  const double squares = 0.5 * innovation.dot(covariance_m2.inverse() * innovation);
  state_.scatter = std::max(1.0, state_.scatter + (squares - state_.scatter) / config_.scatter_matches);
  const double gain = state_.bias_variance_m2 / (0.5 * expected.trace());
  state_.bias.x_m += gain * innovation.x();
  state_.bias.y_m += gain * innovation.y();
  state_.bias_variance_m2 *= 1.0 - gain;
}

}  // namespace rover::slam
