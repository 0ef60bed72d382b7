#include "common/core/zones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace rover {
namespace {

constexpr double kMinAreaM2 = 1e-4;
constexpr double kMaxCoordinateM = 1e6;
constexpr double kSampleM = 0.1;
constexpr size_t kMaxNameBytes = 64;

using Points = std::vector<Eigen::Vector2d>;

// Calls f(a, b) for each side.
template <class F>
void for_sides(const Points& points, F&& f) {
  for (size_t i = 0; i < points.size(); ++i) f(points[i], points[(i + 1) % points.size()]);
}

double area_m2(const Points& points) {
  double twice = 0.0;
  for_sides(points, [&](const auto& a, const auto& b) { twice += a.x() * b.y() - a.y() * b.x(); });
  return 0.5 * std::abs(twice);
}

// Even-odd rule.
bool contains(const Points& points, const Eigen::Vector2d& p) {
  bool inside = false;
  for_sides(points, [&](const auto& a, const auto& b) {
    if ((a.y() > p.y()) == (b.y() > p.y())) return;
    inside ^= p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  });
  return inside;
}

double border_distance_m(const Points& points, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for_sides(points, [&](const auto& a, const auto& b) {
    const double squared = (b - a).squaredNorm();
    const double u = squared > 0.0 ? std::clamp((p - a).dot(b - a) / squared, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (a + u * (b - a) - p).norm());
  });
  return nearest;
}

double depth_m(const std::vector<Zone>& zones, const Eigen::Vector2d& p) {
  const Zone* zone = forbidding_zone(zones, p);
  if (zone == nullptr) return 0.0;
  if (!zone->keep_in) return border_distance_m(zone->points, p);
  double nearest = std::numeric_limits<double>::infinity();  // of the keep-ins, any will do
  for (const Zone& other : zones)
    if (other.keep_in) nearest = std::min(nearest, border_distance_m(other.points, p));
  return nearest;
}

}  // namespace

std::string zones_problem(const std::vector<Zone>& zones) {
  if (zones.size() > kMaxZones) return "more than " + std::to_string(kMaxZones) + " zones";
  std::set<std::string> names;
  size_t corners = 0;
  for (const Zone& zone : zones) {
    const std::string name = "zone '" + zone.name + "'";
    if (zone.name.empty()) return "a zone has no name";
    const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    if (zone.name.size() > kMaxNameBytes || std::any_of(zone.name.begin(), zone.name.end(), is_control))
      return "the name of a zone is too long or has control characters";
    if (!names.insert(zone.name).second) return name + " is there twice";
    if (zone.points.size() < 3) return name + " has fewer than 3 corners";
    corners += zone.points.size();
    if (corners > kMaxZoneCorners) return "zones with more than " + std::to_string(kMaxZoneCorners) + " corners";
    for (const Eigen::Vector2d& p : zone.points)
      if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kMaxCoordinateM)
        return name + " has a corner that is out of range";
    if (area_m2(zone.points) < kMinAreaM2) return name + " encloses no area";
  }
  return "";
}

const Zone* forbidding_zone(const std::vector<Zone>& zones, const Eigen::Vector2d& p) {
  const Zone* left = nullptr;
  bool kept_in = false;
  for (const Zone& zone : zones) {
    const bool inside = contains(zone.points, p);
    if (inside && !zone.keep_in) return &zone;
    if (inside) kept_in = true;
    if (!inside && zone.keep_in && left == nullptr) left = &zone;
  }
  return kept_in ? nullptr : left;
}

double forbidden_depth_m(const std::vector<Zone>& zones, const Pose2& pose, double half_length_m, double half_width_m) {
  if (zones.empty()) return 0.0;
  const int nx = std::max(1, static_cast<int>(std::ceil(2.0 * half_length_m / kSampleM)));
  const int ny = std::max(1, static_cast<int>(std::ceil(2.0 * half_width_m / kSampleM)));
  const Eigen::Rotation2Dd rotation(pose.yaw_rad);
  double deepest = 0.0;
  for (int ix = 0; ix <= nx; ++ix)
    for (int iy = 0; iy <= ny; ++iy) {
      const Eigen::Vector2d in_body(half_length_m * (2.0 * ix / nx - 1.0), half_width_m * (2.0 * iy / ny - 1.0));
      deepest = std::max(deepest, depth_m(zones, Eigen::Vector2d(pose.x_m, pose.y_m) + rotation * in_body));
    }
  return deepest;
}

}  // namespace rover
