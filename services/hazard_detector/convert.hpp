// Between the messages and the core.
#pragma once

#include <rover/disparity_t.hpp>
#include <rover/hazards_t.hpp>
#include <string>

#include "hazard_detector/hazard_detector.hpp"

namespace rover::hazard {

// What is wrong with the message; empty: nothing.
std::string fault_of(const disparity_t& message);

void hazards_to(const HazardResult& result, const GridShape& shape, hazards_t& message);

}  // namespace rover::hazard
