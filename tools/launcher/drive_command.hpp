// ./rover drive: the stack without the simulator, for the drivers of a vehicle.
#pragma once

#include <string>
#include <vector>

namespace rover {

struct DriveArguments {
  std::string source_dir = ".";     // contains config/ and logs/
  std::string bin_dir;              // contains the services' executables
  std::string config_dir;           // empty: source_dir/config
  std::string ground;               // start pose and path; empty: config_dir/ground.yaml
  std::string map;                  // orbital map; empty: none
  std::string picture;              // from orbit; empty: none
  std::string bus;                  // LCM URL; empty: of bus.yaml
  std::string out;                  // run folder; empty: logs/<time>-drive
  std::string record;               // full or reduced; empty: of recorder.yaml
  std::string level = "efficient";  // or auto: with the services of the Full level
  std::vector<std::string> set;     // file.key.key=value
  double timeout_s = 20.0;          // for the driver's first TICK
  bool headless = false;
  bool until_goal = false;
};

// Exit status 0: the goal was reached; 2: bad input, or no driver; 1: anything else.
int drive(const DriveArguments& arguments);

}  // namespace rover
