#include "tools/oracle/shorten.hpp"

#include <algorithm>

#include "path_planner/dubins.hpp"

namespace rover::oracle {
namespace {

constexpr int kAhead = 40;  // poses: 12 m
constexpr int kPasses = 6;
constexpr double kEnoughGain = 2e-4;  // of the length

double cost_m(const Pieces& pieces) {
  double sum = 0.0;
  for (const Piece& piece : pieces)
    sum += piece.is_turn() ? TieCosts::kTurnM + TieCosts::kTurnMPerRad * std::abs(piece.turn_rad)
                           : piece.length_m() * (1.0 + (piece.driven_m < 0.0 ? TieCosts::kReverse : 0.0));
  return sum;
}

Pieces split(const Pieces& path) {
  Pieces out;
  for (const Piece& piece : path) {
    const int n = std::max(1, static_cast<int>(std::ceil(piece.length_m() / SearchResult::kStepM - 1e-6)));
    for (int i = 0; i < n; ++i)
      out.push_back(
          {piece.pose_at(static_cast<double>(i) / n), piece.driven_m / n, piece.curvature_per_m, piece.turn_rad});
  }
  return out;
}

class Shortening {
 public:
  Shortening(const Pieces& path, const SearchProblem& problem) : p_(problem), edges_(path.size()) {
    poses_.push_back(problem.start);
    for (size_t i = 0; i < path.size(); ++i) {
      edges_[i] = {path[i]};
      poses_.push_back(path[i].to());
    }
  }

  Pieces run() {
    const int last = static_cast<int>(poses_.size()) - 1;
    best_.assign(poses_.size(), {});
    best_[0].cost_m = 0.0;
    for (int j = 1; j <= last; ++j) {
      reach(j, j - 1, edges_[j - 1], true);
      for (int i = std::max(0, j - kAhead); i < j; ++i)
        for (const Pieces& joined : connections(poses_[i], poses_[j])) reach(j, i, joined, false);
    }
    for (int i = std::max(0, last - kAhead); i < last; ++i)
      for (const Pieces& joined : connections(poses_[i], goal_pose(poses_[i]))) reach(last, i, joined, false);
    Pieces path;
    for (int j = last; j > 0; j = best_[j].from)
      path.insert(path.begin(), best_[j].pieces.begin(), best_[j].pieces.end());
    return path;
  }

 private:
  struct Best {
    double cost_m = kInfinity;
    int from = -1;
    Pieces pieces;
  };

  // `known`: the search checked these pieces.
  void reach(int j, int i, const Pieces& pieces, bool known) {
    const double cost = best_[i].cost_m + cost_m(pieces);
    if (cost >= best_[j].cost_m - 1e-6 || !(known || is_free(pieces))) return;
    best_[j] = {cost, i, pieces};
  }

  bool is_free(const Pieces& pieces) const {
    return std::all_of(pieces.begin(), pieces.end(), [&](const Piece& piece) {
      const int n = std::max(1, static_cast<int>(piece.length_m() / Region::kCellM));
      for (int k = 1; k <= n; ++k)
        if (const Pose2 p = piece.pose_at(static_cast<double>(k) / n); p_.region.cell(p.x_m, p.y_m) < 0) return false;
      return p_.check.is_free(piece);
    });
  }

  // On the circle about the goal, towards which the rover looks from `from`.
  Pose2 goal_pose(const Pose2& from) const {
    const Eigen::Vector2d away = (Eigen::Vector2d(from.x_m, from.y_m) - p_.goal).normalized();
    const Eigen::Vector2d at = p_.goal + (p_.tolerance_m - 1e-6) * away;
    const double bearing = std::atan2(-away.y(), -away.x());
    const bool reverse = std::abs(wrap_angle(bearing - from.yaw_rad)) > 0.5 * kPi;
    return {at.x(), at.y(), reverse ? bearing + kPi : bearing};
  }

  // The cheapest first of: an arc-line-arc path, ahead or in reverse; a line between two point turns.
  std::vector<Pieces> connections(const Pose2& from, const Pose2& to) const {
    std::vector<Pieces> out;
    const double distance_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    if (distance_m < 1e-3) return out;
    for (const double direction : {1.0, -1.0}) {
      const double flip = direction > 0.0 ? 0.0 : kPi;
      const auto path = planning::dubins_path({from.x_m, from.y_m, from.yaw_rad + flip},
                                              {to.x_m, to.y_m, to.yaw_rad + flip}, 1.0 / p_.max_curvature_per_m);
      if (!path || path->length_m() > distance_m + 2.0) continue;
      Pieces pieces;
      Pose2 pose = from;
      for (const planning::ArcSegment& segment : path->segments) {
        if (segment.length_m < 1e-6) continue;
        pieces.push_back({pose, direction * segment.length_m, direction * segment.curvature_per_m, 0.0});
        pose = pieces.back().to();
      }
      out.push_back(std::move(pieces));
    }
    out.push_back(turn_line_turn(from, to, distance_m));
    return out;
  }

  Pieces turn_line_turn(const Pose2& from, const Pose2& to, double distance_m) const {
    const double bearing = std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
    double first = wrap_angle(bearing - from.yaw_rad);
    const bool reverse = std::abs(first) > 0.5 * kPi;
    if (reverse) first = wrap_angle(first + kPi);
    Pieces pieces;
    Pose2 pose = from;
    const auto turn = [&](double angle_rad) {
      if (std::abs(angle_rad) < 1e-6) return;
      pieces.push_back({pose, 0.0, 0.0, angle_rad});
      pose = pieces.back().to();
    };
    turn(first);
    pieces.push_back({pose, reverse ? -distance_m : distance_m, 0.0, 0.0});
    pose = pieces.back().to();
    turn(wrap_angle(to.yaw_rad - pose.yaw_rad));
    return pieces;
  }

  const SearchProblem& p_;
  std::vector<Pieces> edges_;
  std::vector<Pose2> poses_;
  std::vector<Best> best_;
};

}  // namespace

Pieces shortened(const Pieces& path, const SearchProblem& problem) {
  Pieces best = path;
  for (int pass = 0; pass < kPasses; ++pass) {
    const double before_m = length_m(best);
    best = Shortening(split(best), problem).run();
    if (length_m(best) > before_m * (1.0 - kEnoughGain)) break;
  }
  return best;
}

}  // namespace rover::oracle
