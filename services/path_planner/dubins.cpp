#include "path_planner/dubins.hpp"

namespace rover::planning {
namespace {

struct Word {
  double t;
  double p;
  double q;
};

double turn_of(double angle_rad) {
  const double turn = std::fmod(angle_rad, 2.0 * kPi);
  const double positive = turn < 0.0 ? turn + 2.0 * kPi : turn;
  return positive > 2.0 * kPi - 1e-9 ? 0.0 : positive;  // rounding must not make a full circle
}

// Both arcs to the same side; `side` +1: left, -1: right (the mirror image).
std::optional<Word> same_side(double d, double alpha, double beta, double side) {
  const double a = side * alpha;
  const double b = side * beta;
  const double p2 = 2.0 + d * d - 2.0 * std::cos(a - b) + 2.0 * d * (std::sin(a) - std::sin(b));
  if (p2 < 0.0) return std::nullopt;
  const double direction = std::atan2(std::cos(b) - std::cos(a), d + std::sin(a) - std::sin(b));
  return Word{turn_of(direction - a), std::sqrt(p2), turn_of(b - direction)};
}

std::optional<Word> other_side(double d, double alpha, double beta, double side) {
  const double a = side * alpha;
  const double b = side * beta;
  const double p2 = -2.0 + d * d + 2.0 * std::cos(a - b) + 2.0 * d * (std::sin(a) + std::sin(b));
  if (p2 < 0.0) return std::nullopt;
  const double p = std::sqrt(p2);
  const double direction = std::atan2(-std::cos(a) - std::cos(b), d + std::sin(a) + std::sin(b)) - std::atan2(-2.0, p);
  return Word{turn_of(direction - a), p, turn_of(direction - b)};
}

}  // namespace

std::optional<DubinsPath> dubins_path(const Pose2& from, const Pose2& to, double radius_m) {
  const double dx = to.x_m - from.x_m;
  const double dy = to.y_m - from.y_m;
  const double d = std::hypot(dx, dy) / radius_m;
  const double bearing = std::atan2(dy, dx);
  const double alpha = from.yaw_rad - bearing;
  const double beta = to.yaw_rad - bearing;
  std::optional<DubinsPath> best;
  const auto offer = [&](const std::optional<Word>& word, double first, double last) {
    if (!word) return;
    const DubinsPath path{{ArcSegment{first / radius_m, word->t * radius_m}, ArcSegment{0.0, word->p * radius_m},
                           ArcSegment{last / radius_m, word->q * radius_m}}};
    if (!best || path.length_m() < best->length_m()) best = path;
  };
  offer(same_side(d, alpha, beta, 1.0), 1.0, 1.0);
  offer(same_side(d, alpha, beta, -1.0), -1.0, -1.0);
  offer(other_side(d, alpha, beta, 1.0), 1.0, -1.0);
  offer(other_side(d, alpha, beta, -1.0), -1.0, 1.0);
  return best;
}

}  // namespace rover::planning
