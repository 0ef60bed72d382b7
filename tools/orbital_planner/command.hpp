// What ./rover plan does.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/bus/user_files.hpp"

namespace rover::orbital {

struct Arguments {
  std::string map;
  std::string start, goal;       // "x,y" or "longitude,latitude"
  std::vector<std::string> via;  // in this order, between start and goal
  bool lon_lat = false;
  std::string out;  // a folder that is new or empty; empty: default_folder()
  std::string config_dir = project_dir() + "/config";
};

// One place "a,b"; throws ConfigError naming the option where it is none.
Eigen::Vector2d parse_place(const std::string& text, const std::string& option);

// In the project's folder: logs/<time>-plan-<name of the map>.
std::string default_folder(const std::string& map);

// Plans and writes, all or nothing; returns what to print. Throws ConfigError or DtmError with one line.
std::string run(const Arguments& arguments);

}  // namespace rover::orbital
