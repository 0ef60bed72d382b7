// The section "matcher" of a service's parameters.
#pragma once

#include "common/bus/parameters.hpp"
#include "common/stereo/block_matcher.hpp"

namespace rover::stereo {

void add_matcher(Parameters p, MatcherConfig& c);

}  // namespace rover::stereo
