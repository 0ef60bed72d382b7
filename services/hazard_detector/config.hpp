// config/hazard_detector.yaml (and vehicle.yaml, and the calibration where there is one) into what the core needs.
#pragma once

#include <string>

#include "common/core/time.hpp"
#include "hazard_detector/hazard_config.hpp"

namespace rover::hazard {

struct NodeConfig {
  HazardConfig core;
  Utime latency_us = 60'000;
};

// The calibration's file beside the others; hazard_calibrate writes it. Without it the camera's mount counts.
inline constexpr char kCalibrationFile[] = "hazard_detector_calibration.yaml";

NodeConfig load_config(const std::string& config_dir);

}  // namespace rover::hazard
