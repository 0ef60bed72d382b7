#include "localization/imu_monitor.hpp"

namespace rover::loc {
namespace {

bool same(const ImuSample& a, const ImuSample& b) {
  return a.delta_angle_rad == b.delta_angle_rad && a.delta_velocity_mps == b.delta_velocity_mps;
}

}  // namespace

bool ImuMonitor::add(const ImuSample& sample) {
  repeats_ = same(sample, last_) ? repeats_ + 1 : 0;
  last_ = sample;
  if (!sample.healthy || frozen()) return false;
  last_valid_utime_ = sample.utime;
  return true;
}

bool ImuMonitor::healthy(Utime now) const {
  return last_valid_utime_ != kNever && to_seconds(now - last_valid_utime_) <= config_.timeout_s;
}

}  // namespace rover::loc
