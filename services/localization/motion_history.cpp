#include "localization/motion_history.hpp"

#include <algorithm>

#include "common/core/check.hpp"

namespace rover::loc {

MotionRecord MotionRecord::clipped(Utime from, Utime to) const {
  MotionRecord cut = *this;
  cut.start = std::max(start, from);
  cut.end = std::min(end, to);
  const double share = static_cast<double>(cut.end - cut.start) / static_cast<double>(end - start);
  cut.delta_angle_rad *= share;
  cut.delta_velocity_mps *= share;
  cut.wheel_motion *= share;
  cut.commanded_path_m *= share;
  for (double& turned : cut.wheel_turn_rad) turned *= share;
  return cut;
}

void MotionHistory::add(const MotionRecord& record) {
  ROVER_CHECK(record.start < record.end, record.start, record.end);
  ROVER_CHECK(records_.empty() || record.start == end(), record.start);
  records_.push_back(record);
  while (records_.front().end < record.end - span_us_) records_.pop_front();
}

std::vector<MotionRecord> MotionHistory::slice(Utime from, Utime to) const {
  std::vector<MotionRecord> out;
  if (from >= to) return out;  // zero-length records would divide by zero
  auto it = std::upper_bound(records_.begin(), records_.end(), from,
                             [](Utime t, const MotionRecord& r) { return t < r.end; });
  for (; it != records_.end() && it->start < to; ++it) out.push_back(it->clipped(from, to));
  return out;
}

bool MotionHistory::covers(Utime from, Utime to) const {
  return !records_.empty() && records_.front().start <= from && to <= end();
}

}  // namespace rover::loc
