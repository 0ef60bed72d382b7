// The services of the stack in the order of the data flow.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace rover {

inline constexpr std::array kServiceNames = {"recorder",        "stereo",         "visual_odometry",    "localization",
                                             "hazard_detector", "path_planner",   "trajectory_control", "locomotion",
                                             "supervisor",      "mission_control"};

// Services of the Full level. They run only if the level may be Full, and while it needs them.
inline constexpr std::array kFullServiceNames = {"point_cloud", "pan_tilt", "slam", "traversability",
                                                 "global_localization"};

inline bool is_full_service(std::string_view name) {
  return std::find(kFullServiceNames.begin(), kFullServiceNames.end(), name) != kFullServiceNames.end();
}

inline std::vector<std::string> service_names(bool with_full) {
  std::vector<std::string> names(kServiceNames.begin(), kServiceNames.end());
  if (with_full) names.insert(names.end(), kFullServiceNames.begin(), kFullServiceNames.end());
  return names;
}

}  // namespace rover
