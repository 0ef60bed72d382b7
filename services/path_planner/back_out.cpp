#include "path_planner/back_out.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace rover::planning {
namespace {

constexpr double kPieceM = 0.3;
constexpr int kSamples = 6;  // of a piece
constexpr double kBackBinM = 0.1;
constexpr int kBackYawBins = 36;
constexpr double kCurvatureCost = 0.3;  // per metre, at the largest curvature
constexpr double kBendCostM = 0.2;      // of a change of it by the largest curvature
constexpr std::array<double, 5> kBackLevels = {0.0, 0.5, -0.5, 1.0, -1.0};  // of the largest curvature

struct BackNode {
  Pose2 pose;
  double level = 0.0;
  double way_m = 0.0;
  double cost_m = 0.0;
  int parent = -1;
};

class BackSearch {
 public:
  BackSearch(const BackOutConfig& config, const BackOutProblem& problem)
      : config_(config), problem_(problem), places_(2 * static_cast<int>(config.most_way_m / kBackBinM) + 3) {
    const auto places = static_cast<size_t>(places_);
    best_cost_.assign(places * places * kBackYawBins, kInfinity);
  }

  std::vector<Point2> run() {
    offer({problem_.rover});
    while (!open_.empty()) {
      std::pop_heap(open_.begin(), open_.end(), std::greater<>());
      const auto [cost, index] = open_.back();
      open_.pop_back();
      if (config_.way_cost * cost >= least_) break;
      if (cost > best_cost_[key(nodes_[index].pose)]) continue;
      weigh(index);
      for (const double level : kBackLevels) drive(index, level);
    }
    return way_to(best_);
  }

 private:
  size_t key(const Pose2& pose) const {
    const auto place = [&](double v) {
      return std::clamp(static_cast<int>(std::floor(v / kBackBinM)) + places_ / 2, 0, places_ - 1);
    };
    const int heading = heading_bin(pose.yaw_rad, kBackYawBins);
    const int x = place(pose.x_m - problem_.rover.x_m);
    const int y = place(pose.y_m - problem_.rover.y_m);
    const int at = (y * places_ + x) * kBackYawBins + heading;
    return static_cast<size_t>(at);
  }

  void offer(const BackNode& node) {
    double& best = best_cost_[key(node.pose)];
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

  void drive(int index, double level) {
    BackNode next = nodes_[index];
    next.parent = index;
    next.way_m += kPieceM;
    next.cost_m += kPieceM * (1.0 + kCurvatureCost * level * level) + kBendCostM * std::abs(level - next.level);
    next.level = level;
    if (next.way_m > config_.most_way_m) return;
    for (int i = 0; i < kSamples; ++i) {
      next.pose = advanced(next.pose, -kPieceM / kSamples, level * problem_.max_curvature_per_m);
      if (!problem_.check.clear(next.pose)) return;
      if (!problem_.check.all_unseen(next.pose, [](Point2) { return false; })) return;
    }
    offer(next);
  }

  std::vector<Point2> way_to(int index) const {
    std::vector<Point2> out;
    for (int i = index; i >= 0; i = nodes_[i].parent) {
      const BackNode& node = nodes_[i];
      const int samples = node.parent < 0 ? 1 : kSamples;
      for (int k = 0; k < samples; ++k)
        out.push_back(position(advanced(node.pose, kPieceM * k / kSamples, node.level * problem_.max_curvature_per_m)));
    }
    std::reverse(out.begin(), out.end());
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

std::vector<Point2> back_out(const BackOutConfig& config, const BackOutProblem& problem) {
  return BackSearch(config, problem).run();
}

}  // namespace rover::planning
