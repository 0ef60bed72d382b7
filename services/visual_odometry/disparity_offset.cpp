#include "visual_odometry/disparity_offset.hpp"

#include <algorithm>
#include <cmath>

namespace rover::vo {
namespace {

constexpr double kDisplacedBounds = 2.0;  // KITTI's car has 0.9 px, a knock of 0.5 deg makes 3.6 px
constexpr double kRemembered = 0.7;       // of the recent measurements at the next: some three keyframes, 0.5 m

}  // namespace

DisparityOffset::DisparityOffset(const DisparityOffsetConfig& config)
    : config_(config), information_(1.0 / (config.prior_sigma_px * config.prior_sigma_px)) {}

void DisparityOffset::add(const OffsetMeasurement& measurement, double used_px) {
  if (!std::isfinite(measurement.gradient) || !(measurement.information > 0.0)) return;
  information_ += config_.information_factor * measurement.information;
  const double gradient = measurement.gradient + measurement.information * (used_px - px_);
  px_ += config_.information_factor * gradient / information_;
  px_ = std::clamp(px_, -config_.max_px, config_.max_px);
  const double information = config_.information_factor * measurement.information;
  recent_.information = kRemembered * recent_.information + information;
  recent_.gradient =
      kRemembered * recent_.gradient + config_.information_factor * measurement.gradient + information * used_px;
}

bool DisparityOffset::displaced() const {
  if (!(recent_.information > 0.0)) return false;
  const double sigma_px = 1.0 / std::sqrt(recent_.information);
  return std::abs(recent_.gradient / recent_.information) - 2.0 * sigma_px > kDisplacedBounds * config_.max_px;
}

}  // namespace rover::vo
