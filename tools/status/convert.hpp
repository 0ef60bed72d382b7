// Converts messages to the types of the status.
#pragma once

#include <rover/drive_permit_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/header_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/supervisor_state_t.hpp>

#include "tools/status/bus_statistics.hpp"

namespace rover::status {

MessageInfo message_info(const std::string& channel, const header_t& header, size_t bytes);
Heartbeat report_from(const heartbeat_t& message);
StateReport report_from(const supervisor_state_t& message);
PermitReport report_from(const drive_permit_t& message);
FaultReport report_from(const fault_t& message);

}  // namespace rover::status
