#include "tools/orbital_planner/convert.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/bus/zone_list.hpp"
#include "common/core/frames.hpp"

namespace rover::orbital {
namespace {

using nlohmann::json;

constexpr size_t kNumbersInLine = 10;

static_assert(static_cast<std::int8_t>(Level::kEfficient) == path_t::EFFICIENT &&
              static_cast<std::int8_t>(Level::kFull) == path_t::FULL);

template <class Format>
std::string yaml_list(const std::string& key, size_t count, Format&& text_of) {
  std::string text = fmt::format("  {}: [", key);
  const std::string indent(text.size(), ' ');
  for (size_t i = 0; i < count; ++i) {
    text += text_of(i);
    if (i + 1 == count) break;
    text += (i + 1) % kNumbersInLine == 0 ? ",\n" + indent : ", ";
  }
  return text + "]\n";
}

double rounded_to(double value, double unit) {
  return std::round(value / unit) * unit;
}

json position(const Eigen::Vector2d& map_m, const ToLonLat& to_lon_lat) {
  const Eigen::Vector2d p = to_lon_lat(map_m);
  return {rounded_to(p.x(), 1e-9), rounded_to(p.y(), 1e-9)};
}

json point_json(const Eigen::Vector2d& p) {
  return {rounded_to(p.x(), 1e-4), rounded_to(p.y(), 1e-4)};
}

json segment_feature(const Plan& plan, const PathSegment& segment, const ToLonLat& to_lon_lat) {
  json coordinates = json::array(), map_xy = json::array();
  for (size_t i = segment.first; i <= segment.last; ++i) {
    coordinates.push_back(position(plan.line[i], to_lon_lat));
    map_xy.push_back(point_json(plan.line[i]));
  }
  return {{"type", "Feature"},
          {"geometry", {{"type", "LineString"}, {"coordinates", coordinates}}},
          {"properties",
           {{"level", name_of(segment.level)},
            {"length_m", rounded_to(segment.length_m, 1e-3)},
            {"mean_difficulty", rounded_to(segment.mean_difficulty, 1e-3)},
            {"max_slope_deg", rounded_to(to_deg(segment.max_slope_rad), 1e-2)},
            {"map_xy_m", map_xy}}}};
}

json zone_feature(const Zone& zone, const ToLonLat& to_lon_lat) {
  json ring = json::array(), map_xy = json::array();
  for (size_t i = 0; i <= zone.points.size(); ++i)
    ring.push_back(position(zone.points[i % zone.points.size()], to_lon_lat));
  for (const Eigen::Vector2d& p : zone.points) map_xy.push_back(point_json(p));
  return {{"type", "Feature"},
          {"geometry", {{"type", "Polygon"}, {"coordinates", json::array({ring})}}},
          {"properties", {{"name", zone.name}, {"kind", zone.keep_in ? "keep_in" : "keep_out"}, {"map_xy_m", map_xy}}}};
}

Zone zone_of(const json& feature, const json& geometry, size_t number) {
  const json properties = feature.value("properties", json::object());
  Zone zone{"zone " + std::to_string(number), false, {}};
  if (properties.is_object()) {
    zone.name = properties.value("name", zone.name);
    zone.keep_in = properties.value("kind", "keep_out") == "keep_in";
  }
  for (const json& p : geometry.at("coordinates").at(0)) zone.points.emplace_back(p.at(0), p.at(1));
  if (zone.points.size() > 1 && zone.points.front() == zone.points.back()) zone.points.pop_back();
  return zone;
}

json waypoint_feature(const Line& waypoints, size_t i, const ToLonLat& to_lon_lat) {
  const char* role = i == 0 ? "start" : i + 1 == waypoints.size() ? "goal" : "via";
  return {{"type", "Feature"},
          {"geometry", {{"type", "Point"}, {"coordinates", position(waypoints[i], to_lon_lat)}}},
          {"properties", {{"role", role}, {"map_xy_m", point_json(waypoints[i])}}}};
}

// The section `zones:` of a scenario; names are quoted as JSON, which YAML reads.
std::string zones_yaml(const std::vector<Zone>& zones) {
  std::string text = zones.empty() ? "" : "zones:\n";
  for (const Zone& zone : zones) {
    std::string x, y;
    for (const Eigen::Vector2d& p : zone.points) {
      x += fmt::format("{}{:.4f}", x.empty() ? "" : ", ", p.x());
      y += fmt::format("{}{:.4f}", y.empty() ? "" : ", ", p.y());
    }
    text += fmt::format("  - {{name: {}, kind: {}, x_m: [{}], y_m: [{}]}}\n", json(zone.name).dump(),
                        zone.keep_in ? "keep_in" : "keep_out", x, y);
  }
  return text;
}

}  // namespace

const char* name_of(Level level) {
  return level == Level::kFull ? "FULL" : "EFFICIENT";
}

path_t message_from(const Plan& plan, const PathTerms& terms) {
  path_t message{};
  message.path_id = 1;
  message.frame = path_t::MAP;
  message.kind = path_t::GLOBAL;
  message.corridor_half_width_m = terms.corridor_half_width_m;
  message.goal_tolerance_m = terms.goal_tolerance_m;
  message.point_count = static_cast<std::int32_t>(plan.line.size());
  for (size_t i = 0; i < plan.line.size(); ++i) {
    message.x_m.push_back(plan.line[i].x());
    message.y_m.push_back(plan.line[i].y());
    message.level.push_back(static_cast<std::int8_t>(plan.level[i]));
  }
  zones_to(plan.zones, message);
  message.direction.assign(plan.line.size(), std::int8_t{path_t::FORWARD});
  return message;
}

std::string yaml_from(const Plan& plan, const PathTerms& terms) {
  const size_t count = plan.line.size();
  return "path:\n" + yaml_list("x_m", count, [&](size_t i) { return fmt::format("{:.4f}", plan.line[i].x()); }) +
         yaml_list("y_m", count, [&](size_t i) { return fmt::format("{:.4f}", plan.line[i].y()); }) +
         yaml_list("level", count, [&](size_t i) { return fmt::format("{}", static_cast<int>(plan.level[i])); }) +
         fmt::format("  corridor_half_width_m: {}\n  goal_tolerance_m: {}\n", terms.corridor_half_width_m,
                     terms.goal_tolerance_m) +
         zones_yaml(plan.zones);
}

std::vector<Zone> zones_from_geojson(const std::string& text, const std::string& file) {
  std::vector<Zone> zones;
  try {
    const json root = json::parse(text);
    const json features = root.value("type", "") == "FeatureCollection" ? root.at("features") : json::array({root});
    for (const json& feature : features) {
      const json geometry = feature.value("geometry", feature);
      const std::string type = geometry.is_object() ? geometry.value("type", "") : "";
      if (type == "MultiPolygon" || (type == "Polygon" && geometry.at("coordinates").size() != 1))
        throw ConfigError(file + ": only polygons of one ring can be zones");
      if (type == "Polygon") zones.push_back(zone_of(feature, geometry, zones.size() + 1));
    }
  } catch (const json::exception&) {
    throw ConfigError(file + ": no GeoJSON with polygons");
  }
  if (zones.empty()) throw ConfigError(file + ": has no polygon");
  return zones;
}

std::string geojson_from(const Plan& plan, const Line& waypoints, const ToLonLat& to_lon_lat) {
  json features = json::array();
  for (const PathSegment& segment : plan.segments) features.push_back(segment_feature(plan, segment, to_lon_lat));
  for (size_t i = 0; i < waypoints.size(); ++i) features.push_back(waypoint_feature(waypoints, i, to_lon_lat));
  for (const Zone& zone : plan.zones) features.push_back(zone_feature(zone, to_lon_lat));
  return json{{"type", "FeatureCollection"}, {"features", features}}.dump(1) + "\n";
}

}  // namespace rover::orbital
