// ./rover plan.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/bus/user_files.hpp"

namespace rover::orbital {

struct Arguments {
  std::string map;
  std::string start, goal;       // "x,y" or "longitude,latitude"
  std::vector<std::string> via;  // in order, between start and goal
  bool lon_lat = false;
  std::string zones;  // GeoJSON file; empty: none
  std::string out;    // new or empty folder; empty string: default_folder()
  std::string config_dir = project_dir() + "/config";
};

// Parses a place "a,b"; throws ConfigError with the option's name if invalid.
Eigen::Vector2d parse_place(const std::string& text, const std::string& option);

// logs/<time>-plan-<map name> in the project folder.
std::string default_folder(const std::string& map);

// Plans and writes all files or none; returns the text to print. Throws ConfigError or DtmError.
std::string run(const Arguments& arguments);

}  // namespace rover::orbital
