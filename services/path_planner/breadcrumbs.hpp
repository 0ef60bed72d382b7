// Where the rover has been, in odom, to back up along.
#pragma once

#include <algorithm>
#include <deque>
#include <vector>

#include "path_planner/geometry.hpp"

namespace rover::planning {

class Breadcrumbs {
 public:
  static constexpr double kStepM = 0.1;
  static constexpr double kMaxLengthM = 10.0;
  static constexpr double kRetraceM = 1.0;
  static constexpr double kChordM =
      0.25;  // shorter ones show where the rover slid in a point turn, not where it headed

  // Where the rover comes back to its track, the loop is left out.
  void extend(Point2 rover) {
    const auto passed =
        std::find_if(points_.begin(), points_.end(), [&](Point2 p) { return distance(p, rover) < kStepM; });
    if (passed != points_.end()) {
      points_.erase(passed + 1, points_.end());
      return;
    }
    points_.push_back(rover);
    if (static_cast<double>(points_.size()) * kStepM > kMaxLengthM) points_.pop_front();
  }
  // The rover backs up, not quite on the track, which then ends at its point closest to the rover among the last
  // kRetraceM.
  void retrace(Point2 rover) {
    const size_t window = std::min(points_.size(), static_cast<size_t>(kRetraceM / kStepM));
    size_t nearest = points_.size();
    for (size_t i = points_.size(); i-- > points_.size() - window;)
      if (nearest == points_.size() || distance(points_[i], rover) < distance(points_[nearest], rover)) nearest = i;
    points_.resize(std::min(nearest + 1, points_.size()));
  }
  void clear() { points_.clear(); }
  // Back along the track, at most `distance_m` long. Not from the rover itself: it may have slid sideways in a point
  // turn, and the track turns nowhere that the rover did not.
  std::vector<Point2> back(double distance_m) const {
    if (points_.empty()) return {};
    std::vector<Point2> out = {points_.back()};
    double sum = 0.0;
    for (size_t i = points_.size(); i-- > 0 && sum < distance_m;) {
      const double step = distance(out.back(), points_[i]);
      if (step < (i > 0 ? kChordM : kStepM)) continue;
      const double part = std::min(1.0, (distance_m - sum) / step);
      sum += step;
      const Point2 from = out.back();
      out.push_back({from.x_m + part * (points_[i].x_m - from.x_m), from.y_m + part * (points_[i].y_m - from.y_m)});
    }
    return out;
  }

  const std::deque<Point2>& points() const { return points_; }
  void restore(std::deque<Point2> points) { points_ = std::move(points); }

 private:
  std::deque<Point2> points_;  // the oldest first
};

}  // namespace rover::planning
