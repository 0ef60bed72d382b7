#include "visual_odometry/disparity_offset.hpp"

#include <algorithm>
#include <cmath>

namespace rover::vo {

DisparityOffset::DisparityOffset(const DisparityOffsetConfig& config)
    : config_(config), information_(1.0 / (config.prior_sigma_px * config.prior_sigma_px)) {}

void DisparityOffset::add(const OffsetMeasurement& measurement, double used_px) {
  if (!std::isfinite(measurement.gradient) || !(measurement.information > 0.0)) return;
  information_ += config_.information_factor * measurement.information;
  const double gradient = measurement.gradient + measurement.information * (used_px - px_);
  px_ += config_.information_factor * gradient / information_;
  px_ = std::clamp(px_, -config_.max_px, config_.max_px);
}

}  // namespace rover::vo
