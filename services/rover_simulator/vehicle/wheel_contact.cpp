#include "rover_simulator/vehicle/wheel_contact.hpp"

#include <algorithm>
#include <cmath>

namespace rover {
namespace {

constexpr int kStrips = 3;

// Sums over the segments of one wheel.
struct Sums {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double load = 0.0;  // of magnitudes
  double load_times_across = 0.0;
  double load_times_depth = 0.0;
  std::array<double, 3> by_soil{};
};

// The wheel's plane: f forward and level, u upward in the plane.
struct Plane {
  Eigen::Vector3d f, u, axle;
};

Plane wheel_plane(const Eigen::Matrix3d& R_map_hub) {
  const Eigen::Vector3d axle = R_map_hub.col(1);
  const Eigen::Vector3d f = axle.cross(Eigen::Vector3d::UnitZ()).normalized();
  return {f, f.cross(axle), axle};
}

void add_strip(const ContactConfig& config, const Vehicle& vehicle, HeightCache& heights, const Plane& plane,
               const Eigen::Vector3d& center, double across_m, Sums& sums, WheelContact& contact) {
  const double radius = vehicle.wheel_radius_m, dx = 2.0 * radius / config.segments;
  // Columns are placed on the tread, not under the wheel centre; these differ when the wheel is tilted.
  const Eigen::Vector3d base = center - radius * plane.u;
  double x0 = -radius, z0 = 0.0;
  for (int i = 0; i <= config.segments; ++i) {
    const double x1 = -radius + i * dx;
    const double px = base.x() + x1 * plane.f.x(), py = base.y() + x1 * plane.f.y();
    // Along u from the axle. A column above it is a wall; its nearest point is at axle height.
    const double z1 = std::min(0.0, (heights.height_m(px, py) - base.z()) * plane.u.z() - radius);
    const double x = 0.5 * (x0 + x1), z = 0.5 * (z0 + z1), rise = z1 - z0;
    x0 = x1;
    z0 = z1;
    const double distance_sq = x * x + z * z;
    if (i == 0 || distance_sq >= radius * radius || distance_sq < 1e-12) continue;
    const double distance = std::sqrt(distance_sq), depth = radius - distance,
                 length = std::sqrt(dx * dx + rise * rise);
    const Material material = heights.material(base.x() + x * plane.f.x(), base.y() + x * plane.f.y());
    const auto soil = static_cast<size_t>(material.soil);
    const double load = config.stiffness_npm2[soil] / kStrips * depth * length;
    sums.force -= load / distance * (x * plane.f + z * plane.u);
    sums.load += load;
    sums.load_times_across += load * across_m;
    sums.load_times_depth += load * depth;
    sums.by_soil[soil] += load;
    contact.sinkage_m = std::max(contact.sinkage_m, depth);
    contact.climb_m = std::max(contact.climb_m, material.rock_height_m);
  }
}

}  // namespace

WheelContact find_contact(const ContactConfig& config, const Vehicle& vehicle, HeightCache& heights,
                          const Eigen::Vector3d& p_map_axle, const Eigen::Matrix3d& R_map_hub) {
  WheelContact contact;
  Sums sums;
  const Plane plane = wheel_plane(R_map_hub);
  for (int strip = 0; strip < kStrips; ++strip) {
    const double across_m = vehicle.wheel_width_m * ((strip + 0.5) / kStrips - 0.5);
    add_strip(config, vehicle, heights, plane, p_map_axle + across_m * plane.axle, across_m, sums, contact);
  }
  const double load = sums.force.norm();
  if (load <= 0.0) return contact;
  contact.load_n = load;
  contact.normal = sums.force / load;
  const double depth = sums.load_times_depth / sums.load;
  contact.point =
      p_map_axle + sums.load_times_across / sums.load * plane.axle - (vehicle.wheel_radius_m - depth) * contact.normal;
  for (size_t soil = 0; soil < 3; ++soil) contact.soil_fraction[soil] = sums.by_soil[soil] / sums.load;
  return contact;
}

double climb_at_edges_m(const ContactConfig& config, const Vehicle& vehicle, HeightCache& heights,
                        const Eigen::Vector3d& p_map_axle, const Eigen::Matrix3d& R_map_hub) {
  Vehicle wider = vehicle;
  wider.wheel_width_m *= kStrips / (kStrips - 1.0);  // its outer strips lie at the edges of the wheel
  return find_contact(config, wider, heights, p_map_axle, R_map_hub).climb_m;
}

}  // namespace rover
