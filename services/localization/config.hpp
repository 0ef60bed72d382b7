// Reads config/localization.yaml.
#pragma once

#include <string>

#include "localization/localization.hpp"

namespace rover::loc {

LocalizationConfig load_config(const std::string& config_dir);

}  // namespace rover::loc
