// The campaign file: base scenarios, seeds and axes, whose full product are the cells. `blocks` add several products.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/campaign/row.hpp"

namespace rover::campaign {

struct Drive {
  std::string scenario;  // file of the base
  Cell cell;
  std::int64_t seed = 0;
};

struct CampaignFile {
  std::string name;           // of the file, without folder and extension
  std::vector<Drive> drives;  // each cell and seed once; all cells of the first seed come first
};

// Throws ConfigError "file:line: key: what is wrong". Parameters of --set are checked against config_dir.
CampaignFile load_campaign(const std::string& file, const std::string& config_dir);

}  // namespace rover::campaign
