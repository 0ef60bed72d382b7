#include "tools/oracle/pose_search.hpp"

#include <algorithm>
#include <array>

namespace rover::oracle {
namespace {

constexpr int kHeadings = 24;  // of half a circle: the footprint is the same after half a turn
constexpr double kTurnRad = kPi / kHeadings;

struct Node {
  Piece piece;  // that led here
  double cost_m = 0.0;
  int parent = -1;
};

struct Reached {
  Reached() { cost_m.fill(static_cast<float>(kInfinity)); }
  std::array<float, kHeadings> cost_m;
};

class PoseSearch {
 public:
  PoseSearch(const SearchProblem& problem, double heuristic_weight)
      : p_(problem), heuristic_weight_(heuristic_weight) {}

  SearchResult run(int max_expansions) {
    SearchResult result;
    offer({p_.start, 0.0, 0.0, 0.0}, 0.0, -1);
    while (!open_.empty()) {
      std::pop_heap(open_.begin(), open_.end(), std::greater<>());
      const int index = open_.back().second;
      open_.pop_back();
      const Pose2 pose = nodes_[index].piece.to();
      if (nodes_[index].cost_m > static_cast<double>(*reached(pose)) + 1e-4) continue;
      if (std::hypot(pose.x_m - p_.goal.x(), pose.y_m - p_.goal.y()) <= p_.tolerance_m) {
        result.found = true;
        result.path = path_to(index);
        return result;
      }
      if (++result.expansions > max_expansions) return result;
      expand(index, pose);
    }
    result.exhausted = true;
    return result;
  }

 private:
  float* reached(const Pose2& pose) {
    const double turns = pose.yaw_rad / kPi;
    const int heading = std::min(kHeadings - 1, static_cast<int>((turns - std::floor(turns)) * kHeadings));
    return &reached_.at_point(pose.x_m, pose.y_m).cost_m[static_cast<size_t>(heading)];
  }

  void offer(const Piece& piece, double cost_m, int parent) {
    const Pose2 pose = piece.to();
    const double to_goal_m = p_.cost_to_go.at(pose.x_m, pose.y_m);
    if (to_goal_m == kInfinity) return;
    float* best = reached(pose);
    if (cost_m >= *best || (parent >= 0 && !p_.check.is_free(piece))) return;
    *best = static_cast<float>(cost_m);
    open_.emplace_back(static_cast<float>(cost_m + heuristic_weight_ * to_goal_m), static_cast<int>(nodes_.size()));
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
    nodes_.push_back({piece, cost_m, parent});
  }

  void expand(int index, const Pose2& pose) {
    const Piece before = nodes_[index].piece;
    const double cost_m = nodes_[index].cost_m;
    for (const double ratio : {0.0, -0.5, 0.5, -1.0, 1.0})
      for (const double driven_m : {SearchResult::kStepM, -SearchResult::kStepM}) {
        const bool cusp = before.driven_m * driven_m < 0.0;
        const double tie = (driven_m < 0.0 ? TieCosts::kReverse : 0.0) + TieCosts::kCurvature * std::abs(ratio);
        offer({pose, driven_m, ratio * p_.max_curvature_per_m, 0.0},
              cost_m + std::abs(driven_m) * (1.0 + tie) + (cusp ? TieCosts::kCuspM : 0.0), index);
      }
    for (const double turn_rad : {kTurnRad, -kTurnRad})
      offer({pose, 0.0, 0.0, turn_rad},
            cost_m + TieCosts::kTurnMPerRad * kTurnRad + (before.turn_rad * turn_rad > 0.0 ? 0.0 : TieCosts::kTurnM),
            index);
  }

  Pieces path_to(int index) const {
    Pieces path;
    for (; nodes_[index].parent >= 0; index = nodes_[index].parent) path.push_back(nodes_[index].piece);
    std::reverse(path.begin(), path.end());
    return path;
  }

  const SearchProblem& p_;
  double heuristic_weight_;
  TiledGrid<Reached> reached_{Region::kCellM};
  std::vector<Node> nodes_;
  std::vector<std::pair<float, int>> open_;
};

}  // namespace

SearchResult search_poses(const SearchProblem& problem, double heuristic_weight, int max_expansions) {
  return PoseSearch(problem, heuristic_weight).run(max_expansions);
}

}  // namespace rover::oracle
