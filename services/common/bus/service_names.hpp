// The services of the stack at the Efficient level, in the order of its flow.
#pragma once

#include <array>

namespace rover {

inline constexpr std::array kServiceNames = {"recorder",        "stereo",         "visual_odometry",    "localization",
                                             "hazard_detector", "path_planner",   "trajectory_control", "locomotion",
                                             "supervisor",      "mission_control"};

}  // namespace rover
