// The services of the stack, each level's in the order of its flow.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rover {

inline constexpr std::array kServiceNames = {"recorder",        "stereo",         "visual_odometry",    "localization",
                                             "hazard_detector", "path_planner",   "trajectory_control", "locomotion",
                                             "supervisor",      "mission_control"};

// Those of the Full level, which run only where the level may go up to it.
inline constexpr std::array kFullServiceNames = {"point_cloud", "pan_tilt", "slam", "traversability",
                                                 "global_localization"};

inline std::vector<std::string> service_names(bool with_full) {
  std::vector<std::string> names(kServiceNames.begin(), kServiceNames.end());
  if (with_full) names.insert(names.end(), kFullServiceNames.begin(), kFullServiceNames.end());
  return names;
}

}  // namespace rover
