#include "tools/report/polyline.hpp"

#include <algorithm>
#include <limits>

namespace rover::report {
namespace {

struct Foot {
  double distance_m = std::numeric_limits<double>::infinity();
  size_t segment = 0;
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
};

Foot foot_on(const Points& line, const Eigen::Vector2d& p) {
  Foot best;
  for (size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d a = line[i];
    const Eigen::Vector2d ab = (i + 1 < line.size() ? line[i + 1] : a) - a;
    const double length2 = ab.squaredNorm();
    const double u = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
    const Eigen::Vector2d foot = a + u * ab;
    const double distance = (p - foot).norm();
    if (distance < best.distance_m) best = {distance, i, foot};
  }
  return best;
}

}  // namespace

double length_m(const Points& line) {
  double length = 0.0;
  for (size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

double distance_m(const Points& line, const Eigen::Vector2d& p) {
  return foot_on(line, p).distance_m;
}

Points part_ahead(const Points& line, const Eigen::Vector2d& p, double ahead_m) {
  if (line.empty()) return {};
  const Foot foot = foot_on(line, p);
  Points part{foot.point};
  double left = ahead_m;
  for (size_t i = foot.segment + 1; i < line.size() && left > 0.0; ++i) {
    const Eigen::Vector2d step = line[i] - part.back();
    const double length = step.norm();
    if (length > 0.0) part.push_back(part.back() + step * std::min(1.0, left / length));
    left -= length;
  }
  return part;
}

double distance_to_box_m(const Eigen::Vector2d& p_box, double half_length_m, double half_width_m) {
  const double dx = std::max(0.0, std::abs(p_box.x()) - half_length_m);
  const double dy = std::max(0.0, std::abs(p_box.y()) - half_width_m);
  return std::hypot(dx, dy);
}

}  // namespace rover::report
