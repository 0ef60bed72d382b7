// Reads config/hazard_detector.yaml, vehicle.yaml and, if present, the calibration file.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "hazard_detector/hazard_config.hpp"

namespace rover::hazard {

struct NodeConfig {
  HazardConfig core;
  Utime latency_us = 60'000;
};

// Written by hazard_calibrate into the config folder. Without it the camera mount in the messages is used.
inline constexpr char kCalibrationFile[] = "hazard_detector_calibration.yaml";

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::hazard
