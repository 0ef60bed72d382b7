#include "path_planner/pose_history.hpp"

#include <algorithm>

namespace rover::planning {
namespace {

constexpr double kRememberS = 20.0;  // longer than HAZARDS of a computer thirty times slower take

}  // namespace

void PoseHistory::add(const PoseSample& sample) {
  if (!samples_.empty() && sample.utime <= samples_.back().utime) return;
  samples_.push_back(sample);
  while (samples_.front().utime < sample.utime - to_utime(kRememberS)) samples_.pop_front();
}

std::optional<Eigen::Isometry3d> PoseHistory::at(Utime utime) const {
  const auto next = std::lower_bound(samples_.begin(), samples_.end(), utime,
                                     [](const PoseSample& sample, Utime t) { return sample.utime < t; });
  if (next == samples_.end()) return std::nullopt;
  if (next->utime == utime) return next->T_odom_ground;
  if (next == samples_.begin()) return std::nullopt;
  const PoseSample& before = *std::prev(next);
  const double u = static_cast<double>(utime - before.utime) / static_cast<double>(next->utime - before.utime);
  return interpolate(before.T_odom_ground, next->T_odom_ground, u);
}

}  // namespace rover::planning
