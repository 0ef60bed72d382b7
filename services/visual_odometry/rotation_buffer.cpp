#include "visual_odometry/rotation_buffer.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"

namespace rover::vo {
namespace {

constexpr double kMaxRateRadps = 5.0;  // far above the turn rate of a rover
constexpr double kMaxIntervalS = 0.2;
// Minimum fraction of the interval covered by increments.
constexpr double kMinCoverage = 0.999;

bool is_valid(const GyroIncrement& i) {
  return i.delta_angle_rad.allFinite() && std::isfinite(i.dt_s) && i.dt_s > 0.0 && i.dt_s <= kMaxIntervalS &&
         i.delta_angle_rad.norm() <= kMaxRateRadps * i.dt_s;
}

}  // namespace

RotationBuffer::RotationBuffer(Utime span_us) : span_us_(span_us) {}

bool RotationBuffer::add(const GyroIncrement& increment) {
  if (!is_valid(increment)) return false;
  if (!increments_.empty() && increment.utime <= increments_.back().utime) return false;
  increments_.push_back(increment);
  while (increments_.front().utime < increment.utime - span_us_) increments_.pop_front();
  return true;
}

std::optional<Eigen::Matrix3d> RotationBuffer::rotation(Utime from, Utime to) const {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  double covered_s = 0.0;
  for (const GyroIncrement& i : increments_) {
    const double end = to_seconds(std::min(i.utime, to) - from);
    const double start = std::max(0.0, to_seconds(i.utime - from) - i.dt_s);
    const double used = end - start;
    if (used <= 0.0) continue;
    R = R * exp_so3(i.delta_angle_rad * std::min(1.0, used / i.dt_s));
    covered_s += used;
  }
  if (covered_s < kMinCoverage * to_seconds(to - from)) return std::nullopt;
  return R;
}

}  // namespace rover::vo
