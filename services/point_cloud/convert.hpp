// Between the messages and the core.
#pragma once

#include <rover/cloud_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <string>

#include "point_cloud/point_cloud.hpp"

namespace rover::cloud {

// What is wrong with the message; empty: nothing.
std::string fault_of(const ptu_state_t& message, const PanTiltUnit& unit);

void cloud_to(const CloudResult& result, cloud_t& message);

}  // namespace rover::cloud
