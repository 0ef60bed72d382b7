// Conversion between messages and core types.
#pragma once

#include <rover/cloud_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <string>

#include "point_cloud/point_cloud.hpp"

namespace rover::cloud {

// Description of the first invalid field; empty if the message is valid.
std::string fault_of(const ptu_state_t& message, const PanTiltUnit& unit);

void cloud_to(const CloudResult& result, cloud_t& message);

}  // namespace rover::cloud
