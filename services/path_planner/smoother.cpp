#include "path_planner/smoother.hpp"

#include <nlopt.h>

#include <array>
#include <memory>

namespace rover::planning {
namespace {

using Eigen::VectorXd;

constexpr int kStepsPerSegment = 4;
constexpr double kSharpness = 60.0;  // of the soft minimum over the way [1/m]
constexpr double kStartWeight = 0.3;

double length_of(const std::vector<ArcSegment>& segments) {
  double sum = 0.0;
  for (const ArcSegment& arc : segments) sum += arc.length_m;
  return sum;
}

// Mean curvature of the arcs over [from, to].
double mean_curvature(const std::vector<ArcSegment>& segments, double from_m, double to_m) {
  double turned = 0.0;
  double begin = 0.0;
  for (const ArcSegment& arc : segments) {
    const double overlap = std::min(begin + arc.length_m, to_m) - std::max(begin, from_m);
    if (overlap > 0.0) turned += overlap * arc.curvature_per_m;
    begin += arc.length_m;
  }
  return turned / std::max(to_m - from_m, 1e-9);
}

// The way that knots k_0 .. k_n and the length make, with the derivatives of every pose by all unknowns.
class KnotWay {
 public:
  KnotWay(const Pose2& start, int segments) : start_(start), segments_(segments), steps_(segments * kStepsPerSegment) {
    const int unknowns = segments + 2;
    const int poses = steps_ + 1;
    x_.resize(poses);
    y_.resize(poses);
    yaw_.resize(poses);
    dx_.setZero(unknowns, poses);
    dy_.setZero(unknowns, poses);
    dyaw_.setZero(unknowns, poses);
  }

  int steps() const { return steps_; }
  int unknowns() const { return segments_ + 2; }

  void evaluate(const VectorXd& v) {
    const int length_index = segments_ + 1;
    const double ds = v(length_index) / steps_;
    x_(0) = start_.x_m;
    y_(0) = start_.y_m;
    yaw_(0) = start_.yaw_rad;
    for (int m = 0; m < steps_; ++m) {
      // The mean curvature of a step lies in its middle, because it is linear there.
      const double u = (m + 0.5) / kStepsPerSegment;
      const int knot = m / kStepsPerSegment;
      const double f = u - knot;
      yaw_(m + 1) = yaw_(m) + ds * ((1.0 - f) * v(knot) + f * v(knot + 1));
      dyaw_.col(m + 1) = dyaw_.col(m);
      dyaw_(knot, m + 1) += ds * (1.0 - f);
      dyaw_(knot + 1, m + 1) += ds * f;
      dyaw_(length_index, m + 1) = (yaw_(m + 1) - start_.yaw_rad) / v(length_index);
      const double middle = 0.5 * (yaw_(m) + yaw_(m + 1));
      const double c = std::cos(middle);
      const double s = std::sin(middle);
      x_(m + 1) = x_(m) + ds * c;
      y_(m + 1) = y_(m) + ds * s;
      dx_.col(m + 1) = dx_.col(m) - 0.5 * ds * s * (dyaw_.col(m) + dyaw_.col(m + 1));
      dy_.col(m + 1) = dy_.col(m) + 0.5 * ds * c * (dyaw_.col(m) + dyaw_.col(m + 1));
      dx_(length_index, m + 1) += c / steps_;
      dy_(length_index, m + 1) += s / steps_;
    }
  }

  Pose2 pose(int m) const { return {x_(m), y_(m), yaw_(m)}; }
  auto dx(int m) const { return dx_.col(m); }
  auto dy(int m) const { return dy_.col(m); }
  auto dyaw(int m) const { return dyaw_.col(m); }

 private:
  Pose2 start_;
  int segments_;
  int steps_;
  VectorXd x_, y_, yaw_;
  Eigen::MatrixXd dx_, dy_, dyaw_;
};

class SmoothingTask {
 public:
  SmoothingTask(const SmootherConfig& config, const SmoothProblem& problem)
      : config_(config),
        problem_(problem),
        length_m_(length_of(problem.segments)),
        segments_(std::clamp(static_cast<int>(std::ceil(length_m_ / config.knot_m)), 3, config.max_knots)),
        way_(problem.start, segments_) {
    // Four discs along the axis cover the rectangle.
    const double quarter = 0.25 * problem.footprint.half_length_m;
    discs_ = {-3.0 * quarter, -quarter, quarter, 3.0 * quarter};
    disc_radius_m_ = std::hypot(quarter, problem.footprint.half_width_m);
    const std::vector<Pose2> rough = sample(problem.start, problem.segments, length_m_);
    end_ = rough.back();
    guess_ = first_guess();
    way_.evaluate(guess_);
    required_m_ = std::min(disc_radius_m_ + problem.margin_m, least_distance());
  }

  std::optional<std::vector<Pose2>> solve(double step_m) {
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> opt(
        nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(way_.unknowns())), nlopt_destroy);
    VectorXd low = VectorXd::Constant(way_.unknowns(), -config_.max_curvature_per_m);
    VectorXd high = -low;
    low(segments_ + 1) = 0.8 * length_m_;
    high(segments_ + 1) = 1.3 * length_m_;
    nlopt_set_lower_bounds(opt.get(), low.data());
    nlopt_set_upper_bounds(opt.get(), high.data());
    nlopt_set_min_objective(opt.get(), &objective, this);
    const std::array<double, 3> tolerance = {0.1 * config_.end_tolerance_m, 0.1 * config_.end_tolerance_m,
                                             0.1 * config_.end_tolerance_rad};
    nlopt_add_equality_mconstraint(opt.get(), 3, &end_error, this, tolerance.data());
    nlopt_add_inequality_constraint(opt.get(), &clearance_lack, this, 1e-3);
    nlopt_set_maxeval(opt.get(), config_.max_evaluations);
    nlopt_set_ftol_rel(opt.get(), 1e-4);
    VectorXd v = guess_.cwiseMax(low).cwiseMin(high);
    double value = 0.0;
    // Whatever stopped it, the result is judged by itself.
    nlopt_optimize(opt.get(), v.data(), &value);
    if (!v.allFinite()) return std::nullopt;
    return accepted(v, step_m);
  }

 private:
  VectorXd first_guess() const {
    VectorXd v(segments_ + 2);
    const double half = 0.5 * length_m_ / segments_;
    for (int i = 0; i <= segments_; ++i) {
      const double s = length_m_ * i / segments_;
      v(i) = mean_curvature(problem_.segments, std::max(s - half, 0.0), std::min(s + half, length_m_));
    }
    v(segments_ + 1) = length_m_;
    return v;
  }

  Point2 disc_at(const Pose2& pose, double offset_m) const {
    return {pose.x_m + offset_m * std::cos(pose.yaw_rad), pose.y_m + offset_m * std::sin(pose.yaw_rad)};
  }

  double least_distance() const {
    double least = kInfinity;
    Eigen::Vector2d gradient;
    for (int m = 0; m <= way_.steps(); ++m)
      for (const double offset : discs_)
        least = std::min(least, problem_.terrain.hazard_distance_smooth(disc_at(way_.pose(m), offset), gradient));
    return least;
  }

  void update(const double* x) {
    const Eigen::Map<const VectorXd> v(x, way_.unknowns());
    if (current_.size() == v.size() && current_ == v) return;
    current_ = v;
    way_.evaluate(current_);
    sum_clearance();
  }

  // Both clearance terms and their gradients in one pass.
  void sum_clearance() {
    const double wanted = disc_radius_m_ + problem_.margin_m + config_.risk_m;
    const double ds = current_(segments_ + 1) / way_.steps();
    risk_ = 0.0;
    risk_gradient_.setZero(way_.unknowns());
    double sum = 0.0;
    VectorXd sum_gradient = VectorXd::Zero(way_.unknowns());
    for (int m = 0; m <= way_.steps(); ++m)
      for (const double offset : discs_) {
        const Pose2 pose = way_.pose(m);
        Eigen::Vector2d g;
        const double d = problem_.terrain.hazard_distance_smooth(disc_at(pose, offset), g);
        const double lack = wanted - d;
        if (lack <= 0.0) continue;
        const double along = offset * (g.y() * std::cos(pose.yaw_rad) - g.x() * std::sin(pose.yaw_rad));
        const VectorXd dd = g.x() * way_.dx(m) + g.y() * way_.dy(m) + along * way_.dyaw(m);
        risk_ += ds * lack * lack;
        risk_gradient_ -= 2.0 * ds * lack * dd;
        const double weight = std::exp(kSharpness * (required_m_ - d));
        sum += weight;
        sum_gradient -= weight * dd;
      }
    // Kreisselmeier-Steinhauser envelope of required - d <= 0.
    lack_ = sum > 0.0 ? std::log(sum) / kSharpness : -1.0;
    lack_gradient_ = sum > 0.0 ? VectorXd(sum_gradient / sum) : VectorXd::Zero(way_.unknowns());
  }

  static double objective(unsigned n, const double* x, double* gradient, void* self) {
    auto& task = *static_cast<SmoothingTask*>(self);
    task.update(x);
    VectorXd g;
    const double value = task.cost(g);
    if (gradient != nullptr) std::copy_n(g.data(), n, gradient);
    return value;
  }

  double cost(VectorXd& g) const {
    const VectorXd& v = current_;
    const double segment_m = length_m_ / segments_;  // weights keep to the first length: the terms stay quadratic
    g = config_.clearance_weight * risk_gradient_;
    double value = config_.clearance_weight * risk_ + v(segments_ + 1);
    g(segments_ + 1) += 1.0;
    for (int i = 0; i <= segments_; ++i) {
      value += config_.curvature_weight * segment_m * v(i) * v(i);
      g(i) += 2.0 * config_.curvature_weight * segment_m * v(i);
    }
    const auto bend = [&](double weight, double difference, int plus, int minus) {
      value += weight * difference * difference;
      if (plus >= 0) g(plus) += 2.0 * weight * difference;
      if (minus >= 0) g(minus) -= 2.0 * weight * difference;
    };
    for (int i = 0; i < segments_; ++i) bend(config_.bend_weight / segment_m, v(i + 1) - v(i), i + 1, i);
    bend(kStartWeight, v(0) - problem_.start_curvature_per_m, 0, -1);
    bend(kStartWeight, v(segments_), segments_, -1);
    return value;
  }

  static void end_error(unsigned, double* result, unsigned n, const double* x, double* gradient, void* self) {
    auto& task = *static_cast<SmoothingTask*>(self);
    task.update(x);
    const int last = task.way_.steps();
    const Pose2 end = task.way_.pose(last);
    result[0] = end.x_m - task.end_.x_m;
    result[1] = end.y_m - task.end_.y_m;
    result[2] = end.yaw_rad - task.end_.yaw_rad;
    if (gradient == nullptr) return;
    const VectorXd gx = task.way_.dx(last);
    const VectorXd gy = task.way_.dy(last);
    const VectorXd gyaw = task.way_.dyaw(last);
    std::copy_n(gx.data(), n, gradient);
    std::copy_n(gy.data(), n, gradient + n);
    std::copy_n(gyaw.data(), n, gradient + 2 * static_cast<size_t>(n));
  }

  static double clearance_lack(unsigned n, const double* x, double* gradient, void* self) {
    auto& task = *static_cast<SmoothingTask*>(self);
    task.update(x);
    if (gradient != nullptr) std::copy_n(task.lack_gradient_.data(), n, gradient);
    return task.lack_;
  }

  std::optional<std::vector<Pose2>> accepted(const VectorXd& v, double step_m) {
    way_.evaluate(v);
    const Pose2 reached = way_.pose(way_.steps());
    const bool met = distance(position(reached), position(end_)) <= config_.end_tolerance_m &&
                     std::abs(reached.yaw_rad - end_.yaw_rad) <= config_.end_tolerance_rad;
    if (!met) return std::nullopt;
    return poses_along(v, step_m);
  }

  // Arcs between the steps of the integration, each sampled.
  std::vector<Pose2> poses_along(const VectorXd& v, double step_m) const {
    const double ds = v(segments_ + 1) / way_.steps();
    const int parts = std::max(1, static_cast<int>(std::ceil(ds / step_m - 1e-6)));
    std::vector<Pose2> poses = {way_.pose(0)};
    for (int m = 0; m < way_.steps(); ++m) {
      const double curvature = (way_.pose(m + 1).yaw_rad - way_.pose(m).yaw_rad) / ds;
      for (int i = 1; i < parts; ++i) poses.push_back(advanced(way_.pose(m), ds * i / parts, curvature));
      poses.push_back(way_.pose(m + 1));
    }
    return poses;
  }

  const SmootherConfig& config_;
  const SmoothProblem& problem_;
  double length_m_;
  int segments_;
  KnotWay way_;
  std::array<double, 4> discs_{};
  double disc_radius_m_ = 0.0;
  double required_m_ = 0.0;
  Pose2 end_;
  VectorXd guess_;
  VectorXd current_;
  double risk_ = 0.0;
  double lack_ = 0.0;
  VectorXd risk_gradient_;
  VectorXd lack_gradient_;
};

}  // namespace

std::optional<std::vector<Pose2>> smooth(const SmootherConfig& config, const SmoothProblem& problem, double step_m) {
  return SmoothingTask(config, problem).solve(step_m);
}

std::vector<Pose2> sample(const Pose2& start, const std::vector<ArcSegment>& segments, double step_m) {
  std::vector<Pose2> poses = {start};
  for (const ArcSegment& arc : segments) {
    const Pose2 from = poses.back();
    const int parts = std::max(1, static_cast<int>(std::ceil(arc.length_m / step_m - 1e-6)));
    for (int i = 1; i <= parts; ++i) poses.push_back(advanced(from, arc.length_m * i / parts, arc.curvature_per_m));
  }
  return poses;
}

}  // namespace rover::planning
