#include "test/path_planner/rock_drive.hpp"

#include <ctime>
#include <deque>

namespace rover::planning::testing_support {
namespace {

constexpr double kTurnStartRad = 0.7;
constexpr double kTurnStopRad = 0.035;
constexpr double kAtTheEndM = 0.02;
constexpr double kMostCurvature = 1.0;
constexpr double kSteeringRate = 0.185;  // of the curvature [1/(m s)]
constexpr double kDecelerationMps2 = 0.1;
constexpr double kCreepMps = 0.08;  // while the steering swings far
constexpr double kGoOnM = 0.15;     // what a block must recede after a stop
constexpr double kGazeM = 4.0;      // along the path, where the NavCam looks
constexpr double kMostAzimuthRad = 1.4;
constexpr double kSweepStepRad = 0.7;
constexpr double kSweepAfterS = 2.0;  // of no path

// Odometry that errs in scale and bend.
struct Drift {
  double scale = 1.0;
  double bend_per_m = 0.0;
};

// As trajectory_control: segments between cusps and corners, a stop at each, a point turn at corners.
class Follower {
 public:
  Follower(const DriveConfig& config, const Pose2& start, const Drift& drift)
      : config_(config), drift_(drift), truth_(start) {}

  const Pose2& truth() const { return truth_; }  // in map
  const Pose2& odom() const { return odom_; }
  double forward_mps() const { return direction_ * speed_; }
  double yaw_rate_radps() const { return rate_; }
  double driven_m() const { return driven_m_; }
  int point_turns() const { return point_turns_; }
  bool has_path() const { return !route_.empty(); }
  // Off the heading, to the path ahead.
  double gaze_rad() const {
    if (route_.empty() || direction_ < 0.0) return 0.0;
    const Point2 b = to_body(odom_, route_.point_at(progress_m_ + kGazeM));
    return std::clamp(std::atan2(b.y_m, b.x_m), -kMostAzimuthRad, kMostAzimuthRad);
  }

  void take(const LocalPath& path) {
    route_ = Route(path.points);
    progress_m_ = route_.closest(position(odom_), 0.0, std::min(1.0, route_.segment_at(0.0).end_m));
    set_direction();
    const bool turn = std::abs(heading_error()) > (turning_ ? kTurnStopRad : kTurnStartRad);
    if (turn && !turning_) begin_turn();
    turning_ = turn;
  }

  void halt() {
    speed_ = 0.0;
    rate_ = 0.0;
  }

  // False at the end of the path.
  bool move() {
    const double segment_end = advance();
    if (route_.length_m() - progress_m_ < kAtTheEndM) {
      halt();
      return false;
    }
    if (std::abs(heading_error()) > kTurnStartRad && !turning_) begin_turn();
    if (turning_)
      turn();
    else
      follow(std::sqrt(2.0 * kDecelerationMps2 * std::max(segment_end - progress_m_, 0.002)));
    return true;
  }

 private:
  double step_s() const { return to_seconds(config_.step_us); }

  double heading_error() const { return wrap_angle(route_.pose_at(progress_m_).yaw_rad - odom_.yaw_rad); }

  void set_direction() {
    const double direction = route_.segment_at(progress_m_).reverse ? -1.0 : 1.0;
    if (direction != direction_) curvature_ = -curvature_;
    direction_ = direction;
  }

  void begin_turn() {
    turning_ = true;
    ++point_turns_;
    turn_wait_s_ = config_.turn_overhead_s;
  }

  // Along the segment between two corners or cusps; returns where it ends.
  double advance() {
    const auto& corners = route_.corners();
    const auto next =
        std::find_if(corners.begin(), corners.end(), [&](size_t i) { return route_.s_at(i) > progress_m_; });
    const PathSegment segment = route_.segment_at(progress_m_);
    const double begin =
        std::max(segment.begin_m, next == corners.begin() ? 0.0 : route_.s_at(*std::prev(next)) + 1e-6);
    const double end = std::min(segment.end_m, next == corners.end() ? segment.end_m : route_.s_at(*next));
    progress_m_ = route_.closest(position(odom_), std::max(progress_m_ - 0.3, begin), std::min(progress_m_ + 0.5, end));
    if (end < route_.length_m() && end - progress_m_ < 0.03 && !turning_) {
      progress_m_ = end + 1e-3;
      set_direction();
      if (end < segment.end_m) begin_turn();
    }
    return end;
  }

  void turn() {
    halt();
    turn_wait_s_ -= step_s();
    if (turn_wait_s_ > 0.0) return;
    const double error = heading_error();
    const double most = config_.turn_rate_radps * step_s();
    const double step = std::clamp(error, -most, most);
    rate_ = step / step_s();
    truth_.yaw_rad += step;
    odom_.yaw_rad += step;
    if (std::abs(error) < kTurnStopRad) turning_ = false;
  }

  // Feedback of cross-track and heading errors around the path's curvature, with the steering's rate.
  double wanted_curvature() const {
    const double left_m = direction_ * to_body(route_.pose_at(progress_m_), position(odom_)).y_m;
    const double ahead = progress_m_ + 0.1;
    const double bend = wrap_angle(route_.pose_at(ahead + 0.15).yaw_rad - route_.pose_at(ahead - 0.15).yaw_rad);
    const double wanted = bend / 0.3 + 2.0 / 0.6 * heading_error() - left_m / 0.36;
    return std::clamp(wanted, -kMostCurvature, kMostCurvature);
  }

  void follow(double max_mps) {
    const double wanted = wanted_curvature();
    const double change = kSteeringRate * step_s();
    curvature_ += std::clamp(wanted - curvature_, -change, change);
    speed_ = std::min(max_mps, std::abs(wanted - curvature_) > 0.15 ? kCreepMps : config_.speed_mps);
    rate_ = speed_ * curvature_;
    const double step_m = speed_ * step_s();
    truth_ = advanced(truth_, direction_ * step_m, direction_ * curvature_);
    odom_ = advanced(odom_, direction_ * drift_.scale * step_m,
                     (direction_ * curvature_ + drift_.bend_per_m) / drift_.scale);
    driven_m_ += step_m;
  }

  const DriveConfig& config_;
  Drift drift_;
  Pose2 truth_;
  Pose2 odom_;
  Route route_;
  double direction_ = 1.0;
  double progress_m_ = 0.0;
  double speed_ = 0.0;
  double rate_ = 0.0;
  double curvature_ = 0.0;
  double turn_wait_s_ = 0.0;
  double driven_m_ = 0.0;
  int point_turns_ = 0;
  bool turning_ = false;
};

Pose2 start_of(const std::vector<Point2>& path) {
  return {path[0].x_m, path[0].y_m, std::atan2(path[1].y_m - path[0].y_m, path[1].x_m - path[0].x_m)};
}

Drift random_drift(double deviation, std::mt19937_64& random) {
  const double scale = 1.0 + deviation * gauss(random);
  return {scale, 0.02 * deviation * gauss(random)};
}

class Drive {
 public:
  Drive(const DriveConfig& config, const std::vector<Rock>& rocks, const std::vector<Point2>& path, std::uint64_t seed)
      : config_(config),
        rocks_(rocks),
        random_(seed),
        start_(start_of(path)),
        planner_(config.planner, 1),
        rover_(config_, start_, random_drift(config.odometry_drift, random_)),
        nav_view_(config.nav_camera) {
    GlobalPath global{1, {}, 0.75, 0.5};
    for (const Point2& p : path) global.points.push_back({p, kNaN, 0});
    global.zones = config.zones;
    planner_.set_global_path(global);
    planner_.set_start_area(path.front(), 1.5, 0);
    planner_.set_level(config.full);
  }

  DriveResult run() {
    for (now_ = config_.step_us; !over(); now_ += config_.step_us) step();
    result_.duration_s = to_seconds(now_);
    result_.driven_m = rover_.driven_m();
    result_.point_turns = rover_.point_turns();
    std::sort(plan_s_.begin(), plan_s_.end());
    if (!plan_s_.empty()) result_.plan_p99_s = plan_s_[plan_s_.size() * 99 / 100];
    if (!result_.reached && result_.text.empty()) result_.text = result_.collided ? "collision" : "timeout";
    return result_;
  }

 private:
  bool over() const {
    return result_.reached || result_.collided || no_path_s_ >= config_.no_path_s ||
           to_seconds(now_) >= config_.timeout_s;
  }

  void step() {
    planner_.add_pose(sample());
    look();
    if (config_.full) look_far();
    const std::clock_t begin = std::clock();
    const PlannerOutput out = planner_.step(now_);
    plan_s_.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    if (plan_s_.back() < 0.002) plan_s_.pop_back();
    if (out.path) {
      ++result_.paths;
      rover_.take(*out.path);
      if (out.path->kind == PathKind::kBacktrack) ++result_.back_ups;
    }
    result_.replans = out.status.replans;
    result_.text = out.status.text;
    no_path_s_ = out.status.state == PlannerState::kNoPath ? no_path_s_ + to_seconds(config_.step_us) : 0.0;
    result_.reached = out.status.path_id >= 0 && out.status.goal_distance_m <= 0.5;
    move(out.status);
    judge();
  }

  PoseSample sample() const {
    PoseSample s;
    s.utime = now_;
    s.usable = true;
    s.T_odom_ground = from_planar(rover_.odom());
    s.T_map_odom = from_planar(start_);
    s.forward_mps = rover_.forward_mps();
    s.yaw_rate_radps = rover_.yaw_rate_radps();
    return s;
  }

  void look() {
    if (now_ % config_.frame_us == 0)
      frames_.emplace_back(now_ + config_.frame_latency_us,
                           observe(config_.camera, rocks_, rover_.truth(), now_, random_));
    while (!frames_.empty() && frames_.front().first <= now_) {
      planner_.add_hazards(frames_.front().second);
      frames_.pop_front();
    }
  }

  // An image each half a metre and each few degrees of turn; a sweep before the start, and if there is no path.
  void look_far() {
    const bool moved = rover_.driven_m() - nav_at_m_ >= config_.nav_step_m ||
                       std::abs(wrap_angle(rover_.odom().yaw_rad - nav_at_yaw_)) >= config_.nav_turn_rad;
    const bool sweep = nav_seen_ == 0 || (no_path_s_ > kSweepAfterS && rover_.driven_m() > swept_at_m_ + 0.2);
    if (sweep) {
      swept_at_m_ = rover_.driven_m();
      for (double a = -2.0 * kSweepStepRad; a <= 2.01 * kSweepStepRad; a += kSweepStepRad) see(a);
    } else if (moved) {
      see(rover_.gaze_rad());
    }
    if (sweep || moved) maps_.emplace_back(now_ + config_.nav_latency_us, nav_view_.grid(now_));
    while (!maps_.empty() && maps_.front().first <= now_) {
      planner_.add_traversability(maps_.front().second);
      maps_.pop_front();
    }
  }

  void see(double azimuth_rad) {
    nav_view_.look(rocks_, rover_.truth(), rover_.odom(), azimuth_rad);
    nav_at_m_ = rover_.driven_m();
    nav_at_yaw_ = rover_.odom().yaw_rad;
    ++nav_seen_;
  }

  // As the supervisor: stops before a block, and goes on when it has receded or the path is another.
  bool permitted(const PlannerStatus& status) const {
    const double stop = config_.stop_distance_m;
    if (status.path_id < 0 || status.blocked_in_m <= stop || !rover_.has_path()) return false;
    return going_ || status.path_id != stopped_path_ || status.blocked_in_m > stop + kGoOnM;
  }

  void move(const PlannerStatus& status) {
    const bool go = permitted(status);
    if (going_ && !go) {
      ++result_.stops;
      if (status.block_kind == BlockKind::kHazard && status.blocked_in_m <= config_.stop_distance_m)
        ++result_.hazard_stops;
      stopped_path_ = status.path_id;
    }
    going_ = go && rover_.move();
    if (going_) return;
    rover_.halt();
    result_.stopped_s += to_seconds(config_.step_us);
  }

  void judge() {
    const double clearance = clearance_m(config_.planner.footprint, rover_.truth(), rocks_);
    result_.min_clearance_m = std::min(result_.min_clearance_m, clearance);
    result_.collided = clearance < 0.0;
    const Point2 believed = from_body(start_, position(rover_.odom()));
    const Footprint& footprint = config_.planner.footprint;
    result_.zone_depth_m =
        std::max(result_.zone_depth_m,
                 forbidden_depth_m(config_.zones, {believed.x_m, believed.y_m, start_.yaw_rad + rover_.odom().yaw_rad},
                                   footprint.half_length_m, footprint.half_width_m));
    if (result_.track.empty() || distance(position(result_.track.back()), position(rover_.truth())) > 0.2)
      result_.track.push_back(rover_.truth());
  }

  const DriveConfig& config_;
  const std::vector<Rock>& rocks_;
  std::mt19937_64 random_;
  Pose2 start_;
  PathPlanner planner_;
  Follower rover_;
  DriveResult result_;
  Utime now_ = 0;
  std::deque<std::pair<Utime, HazardGrid>> frames_;  // with the time at which the planner gets them
  NavView nav_view_;
  std::deque<std::pair<Utime, TraversabilityGrid>> maps_;  // the same
  double nav_at_m_ = 0.0;
  double nav_at_yaw_ = 0.0;
  double swept_at_m_ = 0.0;
  int nav_seen_ = 0;
  std::vector<double> plan_s_;
  double no_path_s_ = 0.0;
  bool going_ = false;
  std::int64_t stopped_path_ = -1;
};

}  // namespace

std::vector<Zone> random_zones(const std::vector<Point2>& path, int count, std::uint64_t seed) {
  constexpr double kFreeEndM = 2.5;
  std::mt19937_64 random(seed);
  std::vector<Zone> zones;
  for (int i = 0; i < count; ++i) {
    const auto leg = static_cast<size_t>(uniform(random, 0.0, static_cast<double>(path.size() - 1)));
    const double u = uniform(random, 0.0, 1.0);
    const Point2 middle{path[leg].x_m + u * (path[leg + 1].x_m - path[leg].x_m) + uniform(random, -2.0, 2.0),
                        path[leg].y_m + u * (path[leg + 1].y_m - path[leg].y_m) + uniform(random, -4.0, 4.0)};
    const int corners = 3 + static_cast<int>(uniform(random, 0.0, 5.0));
    const double radius_m = uniform(random, 0.4, 3.0);
    Zone zone{"zone " + std::to_string(i), false, {}};
    for (int k = 0; k < corners; ++k) {
      const double angle = 2.0 * kPi * k / corners, r = radius_m * uniform(random, 0.4, 1.0);
      zone.points.emplace_back(middle.x_m + r * std::cos(angle), middle.y_m + r * std::sin(angle));
    }
    const bool free_ends =
        distance(middle, path.front()) > radius_m + kFreeEndM && distance(middle, path.back()) > radius_m + kFreeEndM;
    if (free_ends) zones.push_back(std::move(zone));
  }
  return zones;
}

DriveResult drive(const DriveConfig& config, const std::vector<Rock>& rocks, const std::vector<Point2>& path,
                  std::uint64_t seed) {
  return Drive(config, rocks, path, seed).run();
}

}  // namespace rover::planning::testing_support
