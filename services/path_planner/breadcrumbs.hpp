// Where the rover has been, in odom, to back up to.
#pragma once

#include <algorithm>
#include <deque>

#include "path_planner/geometry.hpp"

namespace rover::planning {

class Breadcrumbs {
 public:
  static constexpr double kStepM = 0.1;
  static constexpr double kMaxLengthM = 10.0;
  static constexpr double kRetraceM = 1.0;

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
  const std::deque<Point2>& points() const { return points_; }
  void restore(std::deque<Point2> points) { points_ = std::move(points); }

 private:
  std::deque<Point2> points_;  // the oldest first
};

}  // namespace rover::planning
