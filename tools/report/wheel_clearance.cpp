#include "tools/report/wheel_clearance.hpp"

#include <algorithm>
#include <cmath>

namespace rover::report {
namespace {

constexpr double kReachM = 5.0;
constexpr double kGridM = 0.02;

// A rock reaches beyond the circle of its diameter: the axes of its ellipse differ by up to 1.6 (world/rocks.cpp).
std::vector<Rock> with_reach(std::vector<Rock> rocks) {
  for (Rock& rock : rocks) rock.radius_m *= std::sqrt(1.6);
  return rocks;
}

// Points of a rock, 2 cm apart, that rise 0.15 m or more.
Points tall_points(const Rock& rock, const TrueWorld& world) {
  Points points;
  for (double dx = -rock.radius_m; dx <= rock.radius_m; dx += kGridM)
    for (double dy = -rock.radius_m; dy <= rock.radius_m; dy += kGridM) {
      const Eigen::Vector2d p(rock.x_m + dx, rock.y_m + dy);
      if (world.height_m(p.x(), p.y()) - world.ground_m(p.x(), p.y()) >= kHazardRockM) points.push_back(p);
    }
  return points;
}

// The contact point is below the body: a roll of 15 deg moves it by 0.16 m.
Pose2 wheel_pose(const Eigen::Isometry3d& T_map_body, const Eigen::Vector2d& p_body, double steer_rad,
                 double origin_height_m) {
  const Eigen::Vector3d p = T_map_body * Eigen::Vector3d(p_body.x(), p_body.y(), -origin_height_m);
  return {p.x(), p.y(), wrap_angle(planar(T_map_body).yaw_rad + steer_rad)};
}

std::array<double, 6> steering_of(const WheelSample* sample) {
  if (sample == nullptr) return {};
  const std::array<double, 4>& s = sample->steer_rad;
  return {s[0], s[1], 0.0, 0.0, s[2], s[3]};
}

class WheelClearance {
 public:
  WheelClearance(const VehicleWheels& wheels, const TrueWorld& world)
      : wheels_(wheels), world_(world), field_(with_reach(hazards_of(world.rocks))), tall_(field_.rocks().size()) {}

  void add(const Pose2& wheel) {
    const double reach_m = closest_m_ + std::hypot(wheels_.radius_m, 0.5 * wheels_.width_m);
    const Pose2 T_wheel_map = inverse(wheel);
    for (const size_t rock : field_.near({wheel.x_m, wheel.y_m}, reach_m))
      for (const Eigen::Vector2d& p : points_of(rock))
        closest_m_ =
            std::min(closest_m_, distance_to_box_m(transform(T_wheel_map, p), wheels_.radius_m, 0.5 * wheels_.width_m));
  }

  double closest_m() const { return closest_m_ < kReachM ? closest_m_ : kNaN; }

 private:
  const Points& points_of(size_t rock) {
    if (!tall_[rock]) tall_[rock] = tall_points(field_.rocks()[rock], world_);
    return *tall_[rock];
  }

  const VehicleWheels& wheels_;
  const TrueWorld& world_;
  RockIndex field_;
  std::vector<std::optional<Points>> tall_;
  double closest_m_ = kReachM;
};

}  // namespace

double hazard_clearance_m(const RunRecord& run, const Window& window, const VehicleWheels& wheels,
                          double origin_height_m, const TrueWorld& world) {
  if (!world.height_m || !world.ground_m) return kNaN;
  WheelClearance clearance(wheels, world);
  Pose2 last{kInfinity, kInfinity, 0.0};
  for (const TruthSample& sample : run.truth) {
    const Pose2 pose = planar(sample.T_map_body);
    if (!window.contains(sample.t_s) || !far_apart(pose, last)) continue;
    last = pose;
    const std::array<double, 6> steer_rad = steering_of(newest(run.wheels, sample.t_s));
    for (size_t i = 0; i < steer_rad.size(); ++i)
      clearance.add(wheel_pose(sample.T_map_body, wheels.p_body[i], steer_rad[i], origin_height_m));
  }
  return clearance.closest_m();
}

}  // namespace rover::report
