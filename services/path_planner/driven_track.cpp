#include "path_planner/driven_track.hpp"

#include <algorithm>

namespace rover::planning {

void DrivenTrack::extend(Point2 rover) {
  if (!points_.empty() && distance(points_.back(), rover) < kStepM) return;
  points_.push_back(rover);
  if (static_cast<double>(points_.size()) * kStepM > kLongestM) points_.pop_front();
}

void DrivenTrack::retrace(Point2 rover) {
  const size_t window = std::min(points_.size(), static_cast<size_t>(kRetraceM / kStepM));
  size_t nearest = points_.size();
  for (size_t i = points_.size(); i-- > points_.size() - window;)
    if (nearest == points_.size() || distance(points_[i], rover) < distance(points_[nearest], rover)) nearest = i;
  points_.resize(std::min(nearest + 1, points_.size()));
}

std::vector<Point2> DrivenTrack::back(Point2 rover, double way_m) const {
  std::vector<Point2> out = {rover};
  double way = 0.0;
  for (size_t i = points_.size(); i-- > 0 && way < way_m;) {
    const double step = distance(out.back(), points_[i]);
    if (step < kStepM) continue;  // nearer ones tell of the drift of a standing rover, not of the way
    way += step;
    out.push_back(points_[i]);
  }
  return out;
}

}  // namespace rover::planning
