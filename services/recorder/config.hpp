// config/recorder.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "recorder/keep_policy.hpp"

namespace rover::recorder {

struct RecorderConfig {
  KeepConfig keep;
  double part_gb = 4.0;            // maximum size of a log part; 0: unlimited
  double min_free_start_gb = 1.0;  // required free space to start
  double min_free_gb = 0.2;        // stops recording below this, to leave space for the services' text logs
};

RecorderConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::recorder
