#include "slam/pose_history.hpp"

#include <algorithm>

namespace rover::slam {
namespace {

constexpr Utime kHistoryUs = 5'000'000;
constexpr Utime kMaxGapUs = 100'000;  // POSE comes each tick

}  // namespace

void PoseHistory::add(const PoseSample& sample) {
  if (!samples_.empty() && sample.utime <= samples_.back().utime) return;
  samples_.push_back(sample);
  while (samples_.front().utime < sample.utime - kHistoryUs) samples_.pop_front();
}

std::optional<Odometry> PoseHistory::at(Utime utime) const {
  const auto next = std::lower_bound(samples_.begin(), samples_.end(), utime,
                                     [](const PoseSample& sample, Utime t) { return sample.utime < t; });
  if (next == samples_.end()) return std::nullopt;
  if (next->utime == utime) return next->odometry;
  if (next == samples_.begin()) return std::nullopt;
  const PoseSample& previous = *std::prev(next);
  if (next->utime - previous.utime > kMaxGapUs) return std::nullopt;
  const double u = static_cast<double>(utime - previous.utime) / static_cast<double>(next->utime - previous.utime);
  Odometry odometry = next->odometry;
  odometry.T_odom_body = interpolate(previous.odometry.T_odom_body, next->odometry.T_odom_body, u);
  return odometry;
}

}  // namespace rover::slam
