// The scenario of a cell: the base with the rocks, slope, soil and sun of the cell.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "tools/campaign/row.hpp"

namespace rover::campaign {

// Name without extension: the base's, and the axes of the world with their values.
std::string variant_name(const Cell& cell);

// `base_file`: where `base` comes from; paths in it are relative to it.
YAML::Node make_variant(const YAML::Node& base, const std::string& base_file, const Cell& cell);

}  // namespace rover::campaign
