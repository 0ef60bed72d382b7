// config/recorder.yaml.
#pragma once

#include <cstdint>
#include <string>

#include "recorder/keep_policy.hpp"

namespace rover::recorder {

struct RecorderConfig {
  KeepConfig keep;
  double part_gb = 4.0;            // a log that would grow beyond it goes on in a next part; 0: never
  double min_free_start_gb = 1.0;  // below it the recorder does not start
  double min_free_gb = 0.2;        // below it it stops recording, so that the other services' logs find room
};

RecorderConfig load_config(const std::string& file);

}  // namespace rover::recorder
