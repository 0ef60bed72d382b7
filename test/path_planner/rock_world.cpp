#include "rock_world.hpp"

#include <deque>

namespace rover::planning::testing {
namespace {

constexpr double kHazardHeightM = 0.15;
constexpr double kTurnStartRad = 0.7;
constexpr double kTurnStopRad = 0.035;

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

double gauss(std::mt19937_64& random) {
  return std::sqrt(-2.0 * std::log(uniform(random, 1e-12, 1.0))) * std::cos(uniform(random, 0.0, 2.0 * kPi));
}

// Rocks per square metre with at least the diameter: N(D) = integral of 4 k q exp(-q x) / (pi x^2) dx.
double count_above(double k, double diameter_m) {
  const double q = 1.79 + 0.152 / k;
  double sum = 0.0;
  constexpr double kStep = 0.002;
  for (double x = diameter_m; x < 3.0; x += kStep) {
    const double middle = x + 0.5 * kStep;
    sum += 4.0 * k * q * std::exp(-q * middle) / (kPi * middle * middle) * kStep;
  }
  return sum;
}

bool visible(const CameraModel& camera, Point2 b) {
  if (b.x_m < camera.near_m || b.x_m > camera.far_m) return false;
  const double ahead = b.x_m - camera.position.x_m;
  const double depth = ahead * std::cos(camera.pitch_rad) + camera.height_m * std::sin(camera.pitch_rad);
  const double side = b.y_m - camera.position.y_m;
  return side <= camera.tangent * depth - camera.baseline_m && -side <= camera.tangent * depth;
}

// Whether a rock stands between the camera and the ground at b (both in body).
bool shadowed(const CameraModel& camera, const std::vector<Rock>& rocks_body, Point2 b) {
  const double dx = b.x_m - camera.position.x_m;
  const double dy = b.y_m - camera.position.y_m;
  const double length = std::hypot(dx, dy);
  return std::any_of(rocks_body.begin(), rocks_body.end(), [&](const Rock& rock) {
    const double along = ((rock.p.x_m - camera.position.x_m) * dx + (rock.p.y_m - camera.position.y_m) * dy) / length;
    const double aside = std::abs((rock.p.x_m - camera.position.x_m) * dy - (rock.p.y_m - camera.position.y_m) * dx) / length;
    if (along <= 0.0 || along + 0.5 * rock.radius_m >= length || aside >= 0.8 * rock.radius_m) return false;
    return camera.height_m * (1.0 - along / length) < rock.height_m;
  });
}

class Drive {
 public:
  Drive(const DriveConfig& config, const std::vector<Rock>& rocks, const std::vector<Point2>& path, std::uint64_t seed)
      : config_(config), rocks_(rocks), path_(path), random_(seed), planner_(config.planner, 1) {
    scale_ = 1.0 + config.odometry_drift * gauss(random_);
    bend_ = 0.02 * config.odometry_drift * gauss(random_);
    start_ = {path[0].x_m, path[0].y_m, std::atan2(path[1].y_m - path[0].y_m, path[1].x_m - path[0].x_m)};
    truth_ = start_;
  }

  DriveResult run() {
    GlobalPath global{1, {}, 0.75, 0.5};
    for (const Point2& p : path_) global.points.push_back({p, kNaN, 0});
    planner_.set_global_path(global);
    planner_.set_start_area(path_.front(), 1.5, 0);
    // One step before motion, so that the start area is laid.
    for (now_ = config_.step_us; to_seconds(now_) < config_.timeout_s && !result_.reached && !result_.collided &&
         no_path_s_ < config_.no_path_s;
         now_ += config_.step_us)
      step();
    result_.duration_s = to_seconds(now_);
    if (!result_.reached && !result_.collided && result_.text.empty()) result_.text = "timeout";
    return result_;
  }

 private:
  void step() {
    planner_.add_pose(sample());
    if (now_ % config_.frame_us == 0)
      frames_.emplace_back(now_ + config_.frame_latency_us,
                           observe(config_.camera, near_rocks(), truth_, now_, random_));
    while (!frames_.empty() && frames_.front().first <= now_) {
      planner_.add_hazards(frames_.front().second);
      frames_.pop_front();
    }
    const PlannerOutput out = planner_.step(now_);
    if (out.path) take_path(*out.path);
    result_.replans = out.status.replans;
    result_.text = out.status.text;
    no_path_s_ = out.status.state == PlannerState::kNoPath ? no_path_s_ + to_seconds(config_.step_us) : 0.0;
    result_.reached = out.status.path_id >= 0 && out.status.goal_distance_m <= 0.5;
    if (getenv("TRACE") && now_ % 1000000 == 0) printf("%6.1f x %.2f %.2f %.2f state %d blocked %.2f kind %d goal %.2f off %.2f path %ld pts %zu %s exp %d\n", to_seconds(now_), odom_.x_m, odom_.y_m, odom_.yaw_rad, int(out.status.state), out.status.blocked_in_m, int(out.status.block_kind), out.status.goal_distance_m, out.status.corridor_offset_m, long(out.status.path_id), route_.points().size(), out.status.text.c_str(), planner_.last_repair().expansions);
    if (getenv("DUMP") && (now_ == to_utime(atof(getenv("DUMP"))) || (atof(getenv("DUMP")) < 0 && no_path_s_ > 19.85) || (atof(getenv("DUMP")) < -1 && to_seconds(now_) > config_.timeout_s - 0.15))) {
      std::printf("DUMP t %.1f blocked %.2f kind %d text %s pose %.2f %.2f %.2f\n", to_seconds(now_), out.status.blocked_in_m, int(out.status.block_kind), out.status.text.c_str(), odom_.x_m, odom_.y_m, odom_.yaw_rad);
      const auto& map = planner_.memory().map();
      Route active = planner_.active_route();
      for (int iy = map.origin().iy + map.cells() - 1; iy >= map.origin().iy; --iy) {
        for (int ix = map.origin().ix; ix < map.origin().ix + map.cells(); ++ix) {
          const auto& c = map.get({ix, iy});
          Point2 p{map.center_x_m({ix, iy}), map.center_y_m({ix, iy})};
          char ch = c.hits >= 2 ? '#' : c.hits ? '+' : c.seen ? '.' : ' ';
          if (config_.planner.footprint.distance_m(odom_, p) < 0) ch = 'R';
          if (!active.empty() && distance(active.point_at(active.closest(p)), p) < 0.05) ch = 'o';
          for (const Rock& r : rocks_) { const Pose2 T = start_; Point2 q{T.x_m + std::cos(T.yaw_rad) * p.x_m - std::sin(T.yaw_rad) * p.y_m, T.y_m + std::sin(T.yaw_rad) * p.x_m + std::cos(T.yaw_rad) * p.y_m}; if (ch == ' ' && r.height_m >= 0.15 && distance(r.p, q) < r.radius_m) ch = '?'; }
          putchar(ch);
        }
        putchar('\n');
      }
    }
    move(out.status);
    judge();
  }

  PoseSample sample() const {
    PoseSample s;
    s.utime = now_;
    s.usable = true;
    s.T_odom_body = from_planar(odom_);
    s.T_map_odom = from_planar(start_);
    s.position_variance_m2 = std::pow(config_.odometry_drift * result_.driven_m, 2);
    s.forward_mps = speed_;
    s.yaw_rate_radps = rate_;
    s.travelled_m = result_.driven_m;
    return s;
  }

  std::vector<Rock> near_rocks() const {
    std::vector<Rock> near;
    for (const Rock& rock : rocks_)
      if (distance(rock.p, position(truth_)) < 5.0) near.push_back(rock);
    return near;
  }

  void take_path(const LocalPath& path) {
    route_ = Route(path.points);
    progress_ = route_.closest(position(odom_), 0.0, 1.0);
    const double error = wrap_angle(route_.pose_at(progress_).yaw_rad - odom_.yaw_rad);
    const bool turn = std::abs(error) > (turning_ ? kTurnStopRad : kTurnStartRad);
    if (turn && !turning_) begin_turn();
    turning_ = turn;
  }

  void begin_turn() {
    turning_ = true;
    ++result_.point_turns;
    turn_wait_s_ = config_.turn_overhead_s;
  }

  void move(const PlannerStatus& status) {
    const double stop = status.block_kind == BlockKind::kUnseen ? config_.unseen_stop_m : config_.hazard_stop_m;
    const bool go = status.path_id >= 0 && status.blocked_in_m > stop && !route_.empty();
    if (go && !going_ && status.path_id == stopped_path_ && status.blocked_in_m <= stop + 0.15) return halt();
    if (!go) {
      if (going_) {
        ++result_.stops;
        stopped_path_ = status.path_id;
      }
      return halt();
    }
    going_ = true;
    const double dt = to_seconds(config_.step_us);
    follow_leg(dt);
  }

  // As trajectory_control: legs between kinks, a halt and a point turn at each.
  void follow_leg(double dt) {
    const auto& kinks = route_.kinks();
    const auto next = std::find_if(kinks.begin(), kinks.end(), [&](size_t i) { return route_.s_at(i) > progress_; });
    const auto before = next == kinks.begin() ? kinks.end() : std::prev(next);
    const double leg_begin = before == kinks.end() ? 0.0 : route_.s_at(*before) + 1e-6;
    const double leg_end = next == kinks.end() ? route_.length_m() : route_.s_at(*next);
    progress_ = route_.closest(position(odom_), std::max(progress_ - 0.3, leg_begin), std::min(progress_ + 0.5, leg_end));
    if (next != kinks.end() && leg_end - progress_ < 0.03 && !turning_) {
      progress_ = leg_end + 1e-3;
      begin_turn();
    }
    if (route_.length_m() - progress_ < 0.02) return halt();
    const double error = wrap_angle(route_.pose_at(progress_).yaw_rad - odom_.yaw_rad);
    if (std::abs(error) > kTurnStartRad && !turning_) begin_turn();
    if (turning_) return turn(error, dt);
    follow(error, std::sqrt(2.0 * 0.1 * std::max(leg_end - progress_, 0.002)), dt);
  }

  void halt() {
    going_ = false;
    speed_ = 0.0;
    rate_ = 0.0;
    result_.stopped_s += to_seconds(config_.step_us);
  }

  void turn(double error, double dt) {
    speed_ = 0.0;
    rate_ = 0.0;
    turn_wait_s_ -= dt;
    if (turn_wait_s_ > 0.0) return;
    const double step = std::clamp(error, -config_.turn_rate_radps * dt, config_.turn_rate_radps * dt);
    rate_ = step / dt;
    truth_.yaw_rad += step;
    odom_.yaw_rad += step;
    if (std::abs(error) < kTurnStopRad) turning_ = false;
  }

  // Feedback of cross-track and heading errors around the path's curvature, with the steering's rate.
  void follow(double error, double most_mps, double dt) {
    const Pose2 here = route_.pose_at(progress_);
    const Point2 off = to_body(here, position(odom_));
    const double ahead = progress_ + 0.1;
    const double curvature =
        wrap_angle(route_.pose_at(ahead + 0.15).yaw_rad - route_.pose_at(ahead - 0.15).yaw_rad) / 0.3;
    const double wanted = std::clamp(curvature + 2.0 / 0.6 * error - off.y_m / 0.36, -1.0, 1.0);
    const double change = 0.185 * dt;
    curvature_ += std::clamp(wanted - curvature_, -change, change);
    // As trajectory_control: slower where the steering must swing fast.
    speed_ = std::min(most_mps, std::abs(wanted - curvature_) > 0.15 ? 0.08 : config_.speed_mps);
    rate_ = speed_ * curvature_;
    truth_ = advanced(truth_, speed_ * dt, curvature_);
    odom_ = advanced(odom_, scale_ * speed_ * dt, (curvature_ + bend_) / scale_);
    result_.driven_m += speed_ * dt;
  }

  void judge() {
    for (const Rock& rock : rocks_) {
      if (rock.height_m < kHazardHeightM || distance(rock.p, position(truth_)) > 3.0) continue;
      const double clearance = config_.planner.footprint.distance_m(truth_, rock.p) - rock.radius_m;
      result_.least_clearance_m = std::min(result_.least_clearance_m, clearance);
      result_.collided = result_.collided || clearance < 0.0;
    }
    if (result_.track.empty() || distance(position(result_.track.back()), position(truth_)) > 0.2)
      result_.track.push_back(truth_);
  }

  DriveConfig config_;
  const std::vector<Rock>& rocks_;
  std::vector<Point2> path_;
  std::mt19937_64 random_;
  PathPlanner planner_;
  DriveResult result_;
  Pose2 start_;
  Pose2 truth_;  // in map
  Pose2 odom_;
  double scale_ = 1.0;
  double bend_ = 0.0;
  Utime now_ = 0;
  std::deque<std::pair<Utime, HazardGrid>> frames_;
  Route route_;
  double progress_ = 0.0;
  double speed_ = 0.0;
  double rate_ = 0.0;
  double curvature_ = 0.0;
  double turn_wait_s_ = 0.0;
  double no_path_s_ = 0.0;
  bool turning_ = false;
  bool going_ = false;
  std::int64_t stopped_path_ = -1;
};

}  // namespace

std::vector<Rock> rock_field(double k, Point2 low, Point2 high, double least_diameter_m, std::mt19937_64& random) {
  const double total = count_above(k, least_diameter_m);
  const double area = (high.x_m - low.x_m) * (high.y_m - low.y_m);
  const int count = static_cast<int>(std::lround(total * area));
  // Inverse of the cumulative count, by table.
  std::vector<std::pair<double, double>> table;
  for (double d = least_diameter_m; d < 2.0; d += 0.02) table.emplace_back(count_above(k, d) / total, d);
  std::vector<Rock> rocks;
  for (int i = 0; i < count; ++i) {
    const double share = uniform(random, 0.0, 1.0);
    double diameter = least_diameter_m;
    for (const auto& [above, d] : table)
      if (above >= share) diameter = d;
    rocks.push_back({{uniform(random, low.x_m, high.x_m), uniform(random, low.y_m, high.y_m)},
                     0.5 * diameter, 0.5 * diameter});
  }
  return rocks;
}

HazardGrid observe(const CameraModel& camera, const std::vector<Rock>& rocks, const Pose2& pose, Utime utime,
                   std::mt19937_64& random) {
  HazardGrid grid{utime, 0.1, 0.5, -2.0, 35, 40, std::vector<std::uint8_t>(1400, HazardGrid::kUnseen)};
  std::vector<Rock> in_body = rocks;
  for (Rock& rock : in_body) rock.p = to_body(pose, rock.p);
  for (int iy = 0; iy < grid.cells_y; ++iy)
    for (int ix = 0; ix < grid.cells_x; ++ix) {
      const Point2 b{grid.origin_x_m + (ix + 0.5) * grid.cell_m, grid.origin_y_m + (iy + 0.5) * grid.cell_m};
      if (!visible(camera, b)) continue;
      std::uint8_t& cell = grid.cells[static_cast<size_t>(iy) * grid.cells_x + ix];
      const auto rock = std::find_if(in_body.begin(), in_body.end(), [&](const Rock& r) {
        return r.height_m >= kHazardHeightM && distance(r.p, b) <= r.radius_m + 0.03;
      });
      if (rock != in_body.end())
        cell = HazardGrid::kObstacle;
      else if (!shadowed(camera, in_body, b))
        cell = HazardGrid::kFree;
      if (cell == HazardGrid::kFree && uniform(random, 0.0, 1.0) < camera.false_hit_rate / 600.0)
        cell = HazardGrid::kObstacle;
    }
  return grid;
}

DriveResult drive(const DriveConfig& config, const std::vector<Rock>& rocks, const std::vector<Point2>& path,
                  std::uint64_t seed) {
  return Drive(config, rocks, path, seed).run();
}

PathPlannerConfig planner_config() {
  PathPlannerConfig config;
  config.footprint = {0.875, 0.47};
  config.repair.footprint = config.footprint;
  config.ground_z_m = 0.0;
  return config;
}

}  // namespace rover::planning::testing
