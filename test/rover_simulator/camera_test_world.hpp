// Analytic surfaces and rigs for the camera's tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/core/camera_rig.hpp"
#include "common/core/frames.hpp"
#include "rover_simulator/camera/counter_hash.hpp"
#include "rover_simulator/camera/tile_scene.hpp"
#include "rover_simulator/world/surface.hpp"

namespace rover::test {

// z = height + slope_x x + slope_y y, firm soil.
class PlaneSurface : public Surface {
 public:
  explicit PlaneSurface(double height_m = 0.0, double slope_x = 0.0, double slope_y = 0.0)
      : height_m_(height_m), slope_x_(slope_x), slope_y_(slope_y) {}
  double height_m(double x, double y) const override { return height_m_ + slope_x_ * x + slope_y_ * y; }
  Material material(double, double) const override { return {Soil::kFirm, -1, 0.0}; }

 private:
  double height_m_, slope_x_, slope_y_;
};

// Gentle waves, patches of soil, and at most one rock in each square of 1.1 m, up to 0.35 m tall.
class RockySurface : public Surface {
 public:
  explicit RockySurface(double base_m = -4460.0) : base_m_(base_m) {}
  double height_m(double x, double y) const override { return ground_m(x, y) + rock_above_ground(x, y).height_m; }
  Material material(double x, double y) const override {
    const double zone = std::sin(0.31 * x + 0.5) + std::cos(0.27 * y);
    const Soil soil = zone > 0.7 ? Soil::kSand : zone < -0.9 ? Soil::kBedrock : Soil::kFirm;
    const Rock rock = rock_above_ground(x, y);
    return {soil, rock.id, rock.height_m};
  }

 private:
  struct Rock {
    double height_m = 0.0;
    int id = -1;
  };
  double ground_m(double x, double y) const {
    return base_m_ + 0.25 * std::sin(0.2 * x) * std::cos(0.23 * y) + 0.02 * std::sin(1.9 * x + 0.4 * y) +
           0.006 * std::sin(7.0 * x - 9.0 * y) + 0.003 * std::sin(23.0 * x + 17.0 * y);
  }
  static Rock rock_above_ground(double x, double y) {
    constexpr double kSquare_m = 1.1;
    const double ix = std::floor(x / kSquare_m);
    const double iy = std::floor(y / kSquare_m);
    const std::uint64_t h = hash64(hash64(static_cast<std::uint64_t>(static_cast<std::int64_t>(ix))),
                                   static_cast<std::uint64_t>(static_cast<std::int64_t>(iy)));
    const double radius = 0.04 + 0.32 * std::pow(unit_random(h), 3.0);
    const double cx = (ix + 0.4 + 0.2 * unit_random(hash64(h, 1))) * kSquare_m;
    const double cy = (iy + 0.4 + 0.2 * unit_random(hash64(h, 2))) * kSquare_m;
    const double angle = std::atan2(y - cy, x - cx);
    const double edge = radius * (1.0 + 0.15 * std::sin(3.0 * angle + 6.0 * unit_random(hash64(h, 3))));
    const double r = std::hypot(x - cx, y - cy) / edge;
    if (r >= 1.0) return {};
    const double flat = 0.95 * edge * std::pow(1.0 - r * r * r, 0.45);
    return {flat * (1.0 + 0.08 * std::sin(31.0 * x) * std::sin(27.0 * y)), static_cast<int>(h & 0xFFFFFF)};
  }
  double base_m_;
};

// A scene wide enough for the LocCam, and quick to build.
inline TileSceneConfig small_scene() {
  TileSceneConfig config;
  config.fine_radius_m = 4.5;
  config.middle_radius_m = 8.0;
  config.far_radius_m = 30.0;
  return config;
}

// The LocCam of config/cameras.yaml.
inline StereoRig loccam_rig() {
  StereoRig rig;
  rig.width = 512;
  rig.height = 384;
  rig.left = {417.5, 417.5, 257.3, 190.6, {-0.081, 0.043, 0.0004, -0.0003, 0.0}};
  rig.right = {417.9, 417.9, 254.8, 192.2, {-0.079, 0.041, -0.0002, 0.0005, 0.0}};
  rig.T_left_right = make_pose(rotation_from_rpy(to_rad(0.11), to_rad(-0.15), to_rad(0.08)), {0.12, 0.0003, -0.0002});
  rig.T_body_left = make_pose(camera_rotation(to_rad(33.0)), {0.527, 0.074, 0.059});
  return rig;
}

inline StereoRig navcam_rig() {
  StereoRig rig;
  rig.width = 640;
  rig.height = 480;
  rig.left = {818.0, 818.0, 321.5, 238.7, {-0.062, 0.031, 0.0003, 0.0002, 0.0}};
  rig.right = {818.3, 818.3, 318.9, 241.0, {-0.060, 0.030, -0.0002, 0.0001, 0.0}};
  rig.T_left_right = make_pose(rotation_from_rpy(to_rad(-0.07), to_rad(0.12), to_rad(-0.05)), {0.24, 0.0002, 0.0003});
  rig.T_body_left = make_pose(camera_rotation(to_rad(17.0)), {0.45, 0.12, 0.48});
  return rig;
}

// Body 0.62 m above the surface, level, heading `yaw_rad`.
inline Eigen::Isometry3d body_at(const Surface& surface, double x, double y, double yaw_rad = 0.0) {
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw_rad), {x, y, surface.height_m(x, y) + 0.62});
}

}  // namespace rover::test
