// Parser for OpenCV FileStorage XML. OpenCV 4.6 crashes on truncated or damaged files (issues 25946, 15127).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace rover::calibration {

// Elements become keys; texts of several words, and elements "_", become lists. Throws ConfigError "NAME:LINE: reason".
YAML::Node parse_opencv_xml(const std::string& text, const std::string& name);

}  // namespace rover::calibration
