// XML as OpenCV's FileStorage writes it. OpenCV's own parser crashes on cut or changed files (4.6; opencv issues 25946,
// 15127).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace rover::calibration {

// Elements as keys; a text of several words, and elements named "_", as a list. Throws ConfigError
// "NAME:LINE: what is wrong".
YAML::Node parse_opencv_xml(const std::string& text, const std::string& name);

}  // namespace rover::calibration
