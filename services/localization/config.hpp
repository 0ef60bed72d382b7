// config/localization.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "localization/localization.hpp"

namespace rover::loc {

LocalizationConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::loc
