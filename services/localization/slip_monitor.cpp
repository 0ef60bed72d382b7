#include "localization/slip_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace rover::loc {
namespace {

constexpr double kMinWheelTurnRad = 0.002;  // smaller rotations in an interval are encoder noise
constexpr double kMinTractionPathM = 0.02;
constexpr double kMeanTractionM = 10.0;
constexpr double kMaxSideSlip = 0.35;
constexpr double kMinSideSlipBaseM = 0.15;  // shorter distances count as this: their lateral motion is mostly noise

// Displacement to the left in the axes halfway; zero on an arc without side slip.
double lateral_m(const Eigen::Vector3d& motion) {
  const double half = 0.5 * motion.z();
  return std::cos(half) * motion.y() - std::sin(half) * motion.x();
}

// Of the record with wheels that is nearest to the middle.
std::array<double, 4> steering_halfway(const std::vector<MotionRecord>& records) {
  const size_t middle = records.size() / 2;
  for (size_t away = 0; away <= middle; ++away)
    for (const size_t i : {middle + away, middle - away})
      if (i < records.size() && records[i].wheels_valid) return records[i].steer_rad;
  return {};
}

template <class Interval>
void drop_before(std::deque<Interval>& intervals, Utime before) {
  while (!intervals.empty() && intervals.front().end <= before) intervals.pop_front();
}

}  // namespace

void SlipMonitor::add(const MotionRecord& r) {
  ticks_.push_back({r.start, r.end, r.commanded_path_m, r.wheels_valid ? wheels_.path_m(r.wheel_turn_rad) : 0.0});
  drop_before(ticks_, r.end - to_utime(config_.window_s + config_.max_visual_age_s + 1.0));
}

void SlipMonitor::add_visual(const std::vector<MotionRecord>& records, const Eigen::Vector3d& motion) {
  Interval interval{.start = records.front().start, .end = records.back().end, .lateral_m = lateral_m(motion)};
  std::array<double, 6> turned{};
  for (const MotionRecord& r : records) {
    interval.commanded_m += r.commanded_path_m;
    if (r.wheels_valid) interval.wheel_m += wheels_.path_m(r.wheel_turn_rad);
    interval.body_m += r.wheel_motion.head<2>().norm();
    interval.lateral_m -= r.wheel_motion.y();
    for (size_t i = 0; i < turned.size(); ++i) turned[i] += r.wheel_turn_rad[i];
  }
  const auto rolled = wheels_.wheel_travel_m(motion, steering_halfway(records));
  for (size_t i = 0; i < rolled.size(); ++i)
    interval.visual_m +=
        (std::abs(turned[i]) < kMinWheelTurnRad ? std::abs(rolled[i]) : std::copysign(1.0, turned[i]) * rolled[i]) /
        6.0;
  visual_.push_back(interval);
  drop_before(visual_, interval.end - to_utime(config_.window_s + config_.max_visual_age_s + 1.0));
  update_traction();
}

SlipMonitor::Interval SlipMonitor::sum(const std::deque<Interval>& intervals, Utime from, Utime to) {
  Interval total{to, from};
  for (const Interval& i : intervals) {
    const Utime start = std::max(i.start, from);
    const Utime end = std::min(i.end, to);
    if (start >= end) continue;
    const double share = static_cast<double>(end - start) / static_cast<double>(i.end - i.start);
    total.start = std::min(total.start, start);
    total.end = std::max(total.end, end);
    total.commanded_m += share * i.commanded_m;
    total.wheel_m += share * i.wheel_m;
    total.visual_m += share * i.visual_m;
    total.body_m += share * i.body_m;
    total.lateral_m += share * i.lateral_m;
  }
  return total;
}

void SlipMonitor::update_traction() {
  const Utime end = newest_visual_ = visual_.back().end;
  const Interval interval = sum(visual_, end - to_utime(config_.traction_window_s), end);
  update_side_slip(interval);
  if (interval.wheel_m < kMinTractionPathM) return;
  traction_ = std::clamp(interval.visual_m / interval.wheel_m, 0.0, 1.3);  // above 1: sliding downhill
  mean_traction_ += std::min(1.0, visual_.back().wheel_m / kMeanTractionM) * (traction_ - mean_traction_);
}

void SlipMonitor::update_side_slip(const Interval& interval) {
  const double base_m = std::max(interval.body_m, kMinSideSlipBaseM);
  side_slip_ =
      interval.body_m < kMinTractionPathM ? 0.0 : std::clamp(interval.lateral_m / base_m, -kMaxSideSlip, kMaxSideSlip);
}

Slip SlipMonitor::slip(Utime now) const {
  Slip slip;
  const Utime oldest_end = now - to_utime(config_.max_visual_age_s);
  const Utime end = std::clamp(visual_.empty() ? oldest_end : visual_.back().end, oldest_end, now);
  const Utime from = end - to_utime(config_.window_s);
  const Interval rolled = sum(ticks_, from, end);
  const Interval visual = sum(visual_, from, end);
  slip.window_s = std::max(0.0, to_seconds(rolled.end - rolled.start));
  if (slip.window_s <= 0.0) return slip;
  slip.commanded_mps = rolled.commanded_m / slip.window_s;
  slip.wheel_mps = rolled.wheel_m / slip.window_s;
  if (visual.end <= visual.start) return slip;
  double visual_s = 0.0;
  for (const Interval& i : visual_)
    visual_s += std::max(0.0, to_seconds(std::min(i.end, end) - std::max(i.start, from)));
  slip.visual_mps = visual.visual_m / visual_s;
  if (visual.wheel_m < config_.min_wheel_path_m || visual.wheel_m < config_.min_coverage * rolled.wheel_m) return slip;
  slip.slip_ratio = std::clamp(1.0 - visual.visual_m / visual.wheel_m, -1.0, 1.0);
  slip.valid = true;
  return slip;
}

}  // namespace rover::loc
