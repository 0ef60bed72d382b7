// metrics.json. The key names are a public interface.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/report/metrics.hpp"

namespace rover::report {

nlohmann::ordered_json metrics_json(const Metrics& metrics);

}  // namespace rover::report
