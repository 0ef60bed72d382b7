#include "tools/orbital_planner/command.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <ctime>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"
#include "common/bus/user_files.hpp"
#include "common/core/path_limits.hpp"
#include "tools/orbital_planner/config.hpp"
#include "tools/orbital_planner/convert.hpp"
#include "tools/orbital_planner/files.hpp"
#include "tools/orbital_planner/planning_map.hpp"

namespace rover::orbital {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxZonesBytes = 10'000'000;

struct Place {
  std::string option;
  Eigen::Vector2d given;  // as on the command line
};

std::vector<Place> places_of(const Arguments& arguments) {
  std::vector<Place> places{{"--start", parse_place(arguments.start, "--start")}};
  for (const std::string& text : arguments.via) places.push_back({"--via", parse_place(text, "--via")});
  places.push_back({"--goal", parse_place(arguments.goal, "--goal")});
  return places;
}

Line on_map(const std::vector<Place>& places, const Geography& geography, bool lon_lat) {
  Line line;
  for (const Place& place : places) {
    line.push_back(lon_lat ? geography.to_map(place.given) : place.given);
    if (!line.back().allFinite())
      throw ConfigError(fmt::format("{} {},{}: no longitude and latitude of this map", place.option, place.given.x(),
                                    place.given.y()));
  }
  return line;
}

std::vector<Zone> zones_of(const Arguments& arguments, const Geography& geography) {
  if (arguments.zones.empty()) return {};
  std::vector<Zone> zones = zones_from_geojson(read_text(arguments.zones, kMaxZonesBytes), arguments.zones);
  for (Zone& zone : zones)
    for (Eigen::Vector2d& p : zone.points)
      if (arguments.lon_lat) p = geography.to_map(p);
  if (const std::string problem = zones_problem(zones); !problem.empty())
    throw ConfigError(arguments.zones + ": " + problem);
  return zones;
}

// Refuses a goal that is at the start already.
void check_distances(const std::vector<Place>& places, const Line& waypoints, double goal_tolerance_m) {
  for (size_t i = 1; i < waypoints.size(); ++i)
    if (const double distance_m = (waypoints[i] - waypoints[i - 1]).norm(); distance_m <= goal_tolerance_m)
      throw ConfigError(
          fmt::format("{} {},{}: lies {:.2f} m from {} before it; more than {} m are required (goal_tolerance_m of "
                      "navigation.yaml)",
                      places[i].option, places[i].given.x(), places[i].given.y(), distance_m, places[i - 1].option,
                      goal_tolerance_m));
}

std::string problem_of(const Plan& plan, const ElevationMap& map, const Line& waypoints, const PlannerConfig& config) {
  switch (plan.status) {
    case PlanStatus::kPlanned:
      return "";
    case PlanStatus::kOutside:
      return fmt::format("lies outside of the map ({:.1f},{:.1f} m; the map is {:.0f} x {:.0f} m)",
                         waypoints[plan.waypoint].x(), waypoints[plan.waypoint].y(), map.raster.width_m(),
                         map.raster.height_m());
    case PlanStatus::kNoData:
      return "has no map data";
    case PlanStatus::kForbidden: {
      const Zone& zone = *forbidding_zone(plan.zones, waypoints[plan.waypoint]);
      return fmt::format("lies {} '{}'", zone.keep_in ? "outside of keep-in" : "in keep-out", zone.name);
    }
    case PlanStatus::kNotClear:
      return fmt::format(
          "lies {:.1f} m from an obstacle, a zone or unknown ground; {:.1f} m are required (cost.clearance_m)",
          plan.obstacle_distance_m, config.cost.clearance_m);
    case PlanStatus::kUnreachable:
      return "cannot be reached: no traversable path leads there";
  }
  return "";
}

void check(const Plan& plan, const std::vector<Place>& places, const ElevationMap& map, const Line& waypoints,
           const PlannerConfig& config) {
  if (plan.status == PlanStatus::kPlanned) return;
  const Place& place = places[plan.waypoint];
  throw ConfigError(fmt::format("{} {},{}: {}", place.option, place.given.x(), place.given.y(),
                                problem_of(plan, map, waypoints, config)));
}

std::string summary(const Plan& plan, const Line& waypoints, const ElevationMap& map, const std::string& out) {
  std::string text;
  for (const std::string& note : map.notes) text += note + "\n";
  if (map.converted) text += fmt::format("{}/map.tif is the orbital map that defines the frame of the path\n", out);
  text += "terrain:";
  const auto fractions = class_fractions(plan.terrain);
  for (size_t i = 0; i < fractions.size(); ++i)
    text += fmt::format(" {} {:.1f} %", name_of(static_cast<TerrainClass>(i)), 100.0 * fractions[i]);
  double straight_m = 0.0;
  for (size_t i = 1; i < waypoints.size(); ++i) straight_m += (waypoints[i] - waypoints[i - 1]).norm();
  text += fmt::format("\npath: {:.1f} m in {} points, straight line {:.1f} m, cost of {:.0f} m of level ground\n",
                      plan.length_m, plan.line.size(), straight_m, plan.cost_m);
  for (const PathSegment& s : plan.segments)
    text += fmt::format("  {:9} {:6.1f} m  difficulty {:.2f}  slopes to {:.1f} deg\n", name_of(s.level), s.length_m,
                        s.mean_difficulty, to_deg(s.max_slope_rad));
  return text + fmt::format("{}: path.geojson path.yaml path.lcm path.png terrain.tif\n", out);
}

}  // namespace

Eigen::Vector2d parse_place(const std::string& text, const std::string& option) {
  Eigen::Vector2d place;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, place.x());
  const bool comma = first.ec == std::errc() && first.ptr != end && *first.ptr == ',';
  const auto second = comma ? std::from_chars(first.ptr + 1, end, place.y()) : first;
  if (!comma || second.ec != std::errc() || second.ptr != end || !place.allFinite())
    throw ConfigError(option + " '" + text + "': two numbers X,Y without blanks are required");
  return place;
}

std::string default_folder(const std::string& map) {
  const std::time_t now = std::time(nullptr);
  char time[32];
  std::strftime(time, sizeof time, "%Y%m%d-%H%M%S", std::localtime(&now));
  return project_dir() + "/logs/" + time + "-plan-" + fs::path(map).stem().string();
}

std::string run(const Arguments& arguments) {
  const std::vector<Place> places = places_of(arguments);
  const ToolConfig config = load_config(arguments.config_dir);
  const std::string target = arguments.out.empty() ? default_folder(arguments.map) : arguments.out;
  NewFolder out(target);
  PlanningMap ground = read_planning_map(arguments.map, config.planner.terrain);
  const ElevationMap& map = ground.map;
  const Geography geography(map.raster);
  if (arguments.lon_lat && !geography.is_known())
    throw ConfigError("--lonlat: " + arguments.map + " has no planet; give X,Y in metres from its lower left corner");
  const Line waypoints = on_map(places, geography, arguments.lon_lat);
  check_distances(places, waypoints, config.terms.goal_tolerance_m);
  const std::vector<Zone> zones = zones_of(arguments, geography);
  const Plan result = plan(std::move(ground.terrain), waypoints, config.planner, zones);
  check(result, places, map, waypoints, config.planner);
  if (const std::string problem = path_length_problem(result.length_m); !problem.empty()) throw ConfigError(problem);
  write_files(out.dir(), map, geography, result, waypoints, config.terms);
  out.keep();
  return summary(result, waypoints, map, target);
}

}  // namespace rover::orbital
