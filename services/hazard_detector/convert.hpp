// Conversion between LCM messages and the types of the core.
#pragma once

#include <rover/disparity_t.hpp>
#include <rover/hazards_t.hpp>
#include <string>

#include "hazard_detector/hazard_detector.hpp"

namespace rover::hazard {

// Reason why the message is unusable; empty if it is valid.
std::string validation_error(const disparity_t& message);

void hazards_to(const HazardResult& result, const GridShape& shape, hazards_t& message);

}  // namespace rover::hazard
