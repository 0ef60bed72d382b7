#include "tools/campaign/variant.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/core/decimal.hpp"
#include "common/core/frames.hpp"
#include "tools/campaign/axes.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;

// From the first point of the path to the last.
double path_direction_deg(const YAML::Node& path) {
  const YAML::Node x = path["x_m"], y = path["y_m"];
  const size_t last = x.size() - 1;
  return to_deg(std::atan2(y[last].as<double>() - y[0].as<double>(), x[last].as<double>() - x[0].as<double>()));
}

// The direction in which the plane rises.
double toward_deg(const std::string& direction, double path_deg) {
  if (direction == "down") return path_deg > 0.0 ? path_deg - 180.0 : path_deg + 180.0;
  if (direction == "across") return path_deg + 90.0;
  return path_deg;
}

void set_soil(YAML::Node world, const std::string& soil) {
  if (soil != "mixed") {
    world["soil"]["everywhere"] = soil;
  } else if (world["soil"]) {
    world["soil"].remove("everywhere");
  }
}

}  // namespace

std::string variant_name(const Cell& cell) {
  std::string name = cell.at("scenario");
  for (const Axis& axis : axes())
    if (const auto value = cell.find(axis.name); axis.of_world && value != cell.end())
      name += "-" + axis.name + "-" + value->second;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

YAML::Node make_variant(const YAML::Node& base, const std::string& base_file, const Cell& cell) {
  YAML::Node scenario = YAML::Clone(base);
  YAML::Node world = scenario["world"];
  if (const YAML::Node dtm = world["dtm"])
    world["dtm"] = fs::absolute(fs::path(base_file).parent_path() / dtm.Scalar()).lexically_normal().string();
  for (const auto& [axis, value] : cell) {
    if (axis == "rock_area") world["rock_area_k"] = *parse_number(value);
    if (axis == "slope_deg") world["plane"]["slope_deg"] = *parse_number(value);
    if (axis == "slope_direction")
      world["plane"]["toward_deg"] = toward_deg(value, path_direction_deg(scenario["path"]));
    if (axis == "soil") set_soil(world, value);
    if (axis == "fault")
      if (const YAML::Node entry = fault_entry(value); !entry.IsNull()) scenario["faults"].push_back(entry);
    if (axis == "sun_elevation_deg") scenario["sun"]["elevation_deg"] = *parse_number(value);
  }
  return scenario;
}

}  // namespace rover::campaign
