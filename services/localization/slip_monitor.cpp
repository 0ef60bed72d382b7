#include "localization/slip_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace rover::loc {
namespace {

// A wheel that turned less than this in an interval stands: encoder noise.
constexpr double kStandingRad = 0.002;
constexpr double kMinGripPathM = 0.02;
constexpr double kMostSideSlip = 0.35;
constexpr double kSureSideSlipM = 0.15;  // of way: on less, what the images see aside is mostly noise

// To the left, in the axes halfway: of an arc that the wheels make alone it is zero.
double aside_m(const Eigen::Vector3d& motion) {
  const double half = 0.5 * motion.z();
  return std::cos(half) * motion.y() - std::sin(half) * motion.x();
}

template <class Way>
void forget(std::deque<Way>& ways, Utime before) {
  while (!ways.empty() && ways.front().end <= before) ways.pop_front();
}

}  // namespace

void SlipMonitor::add(const MotionRecord& r) {
  ticks_.push_back({r.start, r.end, r.commanded_path_m, r.wheels ? wheels_.path_m(r.turned_rad) : 0.0});
  forget(ticks_, r.end - to_utime(config_.window_s + config_.max_visual_age_s + 1.0));
}

void SlipMonitor::add_visual(const std::vector<MotionRecord>& records, const Eigen::Vector3d& motion) {
  Way way{.start = records.front().start, .end = records.back().end, .aside_m = aside_m(motion)};
  std::array<double, 6> turned{};
  for (const MotionRecord& r : records) {
    way.commanded_m += r.commanded_path_m;
    if (r.wheels) way.wheel_m += wheels_.path_m(r.turned_rad);
    way.rolled_m += r.wheel_motion.head<2>().norm();
    way.aside_m -= r.wheel_motion.y();
    for (size_t i = 0; i < turned.size(); ++i) turned[i] += r.turned_rad[i];
  }
  const auto rolled = wheels_.rolled_m(motion, records[records.size() / 2].steer_rad);
  for (size_t i = 0; i < rolled.size(); ++i)
    way.visual_m +=
        (std::abs(turned[i]) < kStandingRad ? std::abs(rolled[i]) : std::copysign(1.0, turned[i]) * rolled[i]) / 6.0;
  seen_.push_back(way);
  forget(seen_, way.end - to_utime(config_.window_s + config_.max_visual_age_s + 1.0));
  update_grip();
}

SlipMonitor::Way SlipMonitor::sum(const std::deque<Way>& ways, Utime from, Utime to) {
  Way total{to, from};
  for (const Way& w : ways) {
    const Utime start = std::max(w.start, from);
    const Utime end = std::min(w.end, to);
    if (start >= end) continue;
    const double share = static_cast<double>(end - start) / static_cast<double>(w.end - w.start);
    total.start = std::min(total.start, start);
    total.end = std::max(total.end, end);
    total.commanded_m += share * w.commanded_m;
    total.wheel_m += share * w.wheel_m;
    total.visual_m += share * w.visual_m;
    total.rolled_m += share * w.rolled_m;
    total.aside_m += share * w.aside_m;
  }
  return total;
}

void SlipMonitor::update_grip() {
  const Utime end = seen_.back().end;
  const Way way = sum(seen_, end - to_utime(config_.grip_window_s), end);
  update_side_slip(way);
  if (way.wheel_m < kMinGripPathM) return;
  // Bounds: a wheel does not gain more than it rolls, but on the way down it nearly may.
  grip_ = std::clamp(way.visual_m / way.wheel_m, 0.0, 1.3);
}

void SlipMonitor::update_side_slip(const Way& way) {
  const double sure_m = std::max(way.rolled_m, kSureSideSlipM);
  side_slip_ = way.rolled_m < kMinGripPathM ? 0.0 : std::clamp(way.aside_m / sure_m, -kMostSideSlip, kMostSideSlip);
}

Slip SlipMonitor::slip(Utime now) const {
  Slip slip;
  const Utime oldest_end = now - to_utime(config_.max_visual_age_s);
  const Utime end = std::clamp(seen_.empty() ? oldest_end : seen_.back().end, oldest_end, now);
  const Utime from = end - to_utime(config_.window_s);
  const Way rolled = sum(ticks_, from, end);
  const Way seen = sum(seen_, from, end);
  slip.window_s = std::max(0.0, to_seconds(rolled.end - rolled.start));
  if (slip.window_s <= 0.0) return slip;
  slip.commanded_mps = rolled.commanded_m / slip.window_s;
  slip.wheel_mps = rolled.wheel_m / slip.window_s;
  if (seen.end <= seen.start) return slip;
  double seen_s = 0.0;
  for (const Way& w : seen_) seen_s += std::max(0.0, to_seconds(std::min(w.end, end) - std::max(w.start, from)));
  slip.visual_mps = seen.visual_m / seen_s;
  if (seen.wheel_m < config_.min_wheel_path_m || seen.wheel_m < config_.min_cover * rolled.wheel_m) return slip;
  slip.slip_ratio = std::clamp(1.0 - seen.visual_m / seen.wheel_m, -1.0, 1.0);
  slip.valid = true;
  return slip;
}

}  // namespace rover::loc
