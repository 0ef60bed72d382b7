#include "path_planner/back_out.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace rover::planning {
namespace {

constexpr double kPieceM = 0.15;
constexpr int kSamples = 3;  // of a piece
constexpr double kBackBinM = 0.1;
constexpr int kBackYawBins = 36;
constexpr int kDirections = 2;
constexpr double kCurvatureCost = 0.3;  // per metre, at the largest curvature
constexpr double kBendCostM = 0.2;      // of a change of it by the largest curvature
constexpr std::array<double, 5> kBackLevels = {0.0, 0.5, -0.5, 1.0, -1.0};  // of the largest curvature

struct BackNode {
  Pose2 pose;
  double level = 0.0;
  int direction = 0;  // of the piece to here: 1 bow first, -1 stern first
  double way_m = 0.0;
  double cost_m = 0.0;
  int parent = -1;
};

class BackSearch {
 public:
  BackSearch(const BackOutConfig& config, const BackOutProblem& problem)
      : config_(config), problem_(problem), places_(2 * static_cast<int>(config.most_way_m / kBackBinM) + 3) {
    best_cost_.assign(static_cast<size_t>(places_ * places_ * kBackYawBins * kDirections), kInfinity);
  }

  BackOut run() {
    offer({problem_.rover});
    for (int expanded = 0; !open_.empty() && expanded < config_.most_expansions; ++expanded) {
      std::pop_heap(open_.begin(), open_.end(), std::greater<>());
      const auto [cost, index] = open_.back();
      open_.pop_back();
      if (config_.way_cost * cost >= least_) break;
      if (cost > best_cost_[key(nodes_[index])]) continue;
      weigh(index);
      for (const double level : kBackLevels)
        for (const int direction : {-1, 1}) drive(index, level, direction);
    }
    return first_run();
  }

 private:
  size_t key(const BackNode& node) const {
    const Pose2& pose = node.pose;
    const auto place = [&](double v) {
      return std::clamp(static_cast<int>(std::floor(v / kBackBinM)) + places_ / 2, 0, places_ - 1);
    };
    const double turn = pose.yaw_rad / (2.0 * kPi);
    const int heading = std::clamp(static_cast<int>((turn - std::floor(turn)) * kBackYawBins), 0, kBackYawBins - 1);
    const int x = place(pose.x_m - problem_.rover.x_m);
    const int y = place(pose.y_m - problem_.rover.y_m);
    const int at = (y * places_ + x) * kBackYawBins + heading;
    return static_cast<size_t>(kDirections * at + (node.direction > 0 ? 1 : 0));
  }

  void offer(const BackNode& node) {
    double& best = best_cost_[key(node)];
    if (node.cost_m >= best) return;
    best = node.cost_m;
    nodes_.push_back(node);
    open_.emplace_back(node.cost_m, static_cast<int>(nodes_.size()) - 1);
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }

  // As a place to stop at.
  void weigh(int index) {
    const BackNode& node = nodes_[index];
    if (node.way_m < problem_.least_way_m) return;
    const double all = config_.way_cost * node.cost_m + problem_.headings.to_go(node.pose);
    if (all >= least_) return;
    least_ = all;
    best_ = index;
  }

  void drive(int index, double level, int direction) {
    BackNode next = nodes_[index];
    next.parent = index;
    next.way_m += kPieceM;
    next.cost_m += kPieceM * (1.0 + kCurvatureCost * level * level) + kBendCostM * std::abs(level - next.level);
    if (next.direction == -direction) next.cost_m += config_.change_cost_m;
    next.level = level;
    next.direction = direction;
    if (next.way_m > config_.most_way_m) return;
    for (int i = 0; i < kSamples; ++i) {
      next.pose = advanced(next.pose, direction * kPieceM / kSamples, level * problem_.max_curvature_per_m);
      if (!problem_.check.clear(next.pose)) return;
      if (!problem_.check.all_unseen(next.pose, [](Point2) { return false; })) return;
    }
    offer(next);
  }

  BackOut first_run() const {
    std::vector<int> chain;
    for (int i = best_; i >= 0; i = nodes_[i].parent) chain.insert(chain.begin(), i);
    BackOut out;
    if (chain.size() < 2) return out;
    const int direction = nodes_[chain[1]].direction;
    out.ahead = direction > 0;
    out.way.push_back(position(problem_.rover));
    for (size_t k = 1; k < chain.size() && nodes_[chain[k]].direction == direction; ++k) {
      const Pose2& from = nodes_[chain[k - 1]].pose;
      const double curvature = nodes_[chain[k]].level * problem_.max_curvature_per_m;
      for (int i = 1; i <= kSamples; ++i)
        out.way.push_back(position(advanced(from, direction * kPieceM * i / kSamples, curvature)));
    }
    return out;
  }

  const BackOutConfig& config_;
  const BackOutProblem& problem_;
  int places_;
  std::vector<double> best_cost_;
  std::vector<BackNode> nodes_;
  std::vector<std::pair<double, int>> open_;
  double least_ = kInfinity;  // way back and what is left then
  int best_ = -1;
};

}  // namespace

BackOut back_out(const BackOutConfig& config, const BackOutProblem& problem) {
  return BackSearch(config, problem).run();
}

}  // namespace rover::planning
