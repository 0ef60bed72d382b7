// Where the rover has been, in odom: the way back out of a place that has no way on.
#pragma once

#include <deque>
#include <vector>

#include "path_planner/geometry.hpp"

namespace rover::planning {

class DrivenTrack {
 public:
  static constexpr double kStepM = 0.1;
  static constexpr double kLongestM = 10.0;
  static constexpr double kRetraceM = 1.0;

  // The rover goes on: a point every step of the way.
  void extend(Point2 rover);
  // The rover goes back, not quite on the track: it ends at its point closest to the rover, among the last kRetraceM.
  void retrace(Point2 rover);
  void clear() { points_.clear(); }
  // From the rover back along the track in steps of at least kStepM, about `way_m` long; fewer than two points: there
  // is no track.
  std::vector<Point2> back(Point2 rover, double way_m) const;

  const std::deque<Point2>& points() const { return points_; }
  void restore(std::deque<Point2> points) { points_ = std::move(points); }

 private:
  std::deque<Point2> points_;  // the oldest first
};

}  // namespace rover::planning
