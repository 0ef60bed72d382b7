// Reads the section "matcher" of a service's YAML.
#pragma once

#include "common/bus/config.hpp"
#include "common/stereo/block_matcher.hpp"

namespace rover::stereo {

void read_matcher(const Config& yaml, MatcherConfig& matcher);

}  // namespace rover::stereo
