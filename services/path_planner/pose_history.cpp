#include "path_planner/pose_history.hpp"

#include <algorithm>
#include <cmath>

namespace rover::planning {
namespace {

constexpr double kRememberS = 3.0;
constexpr double kStationStepM = 0.1;
constexpr double kStationWayM = 3.0;  // a hazard is passed about this far after it was first seen

}  // namespace

void PoseHistory::add(const PoseSample& sample) {
  if (!samples_.empty() && sample.utime <= samples_.back().utime) return;
  samples_.push_back(sample);
  while (samples_.front().utime < sample.utime - to_utime(kRememberS)) samples_.pop_front();
  if (stations_.empty() || sample.travelled_m >= stations_.back().travelled_m + kStationStepM)
    stations_.push_back({sample.travelled_m, sample.position_variance_m2});
  while (stations_.size() > 1 && stations_[1].travelled_m <= sample.travelled_m - kStationWayM) stations_.pop_front();
}

void PoseHistory::clear() {
  samples_.clear();
  stations_.clear();
}

std::optional<Eigen::Isometry3d> PoseHistory::at(Utime utime) const {
  const auto next = std::lower_bound(samples_.begin(), samples_.end(), utime,
                                     [](const PoseSample& sample, Utime t) { return sample.utime < t; });
  if (next == samples_.end()) return std::nullopt;
  if (next->utime == utime) return next->T_odom_body;
  if (next == samples_.begin()) return std::nullopt;
  const PoseSample& before = *std::prev(next);
  const double u = static_cast<double>(utime - before.utime) / static_cast<double>(next->utime - before.utime);
  return interpolate(before.T_odom_body, next->T_odom_body, u);
}

double PoseHistory::gained_sigma_m() const {
  if (samples_.empty()) return 0.0;
  return std::sqrt(std::max(0.0, samples_.back().position_variance_m2 - stations_.front().variance_m2));
}

}  // namespace rover::planning
