// Health of services and channels, and the colours that show it.
#pragma once

#include <string>

#include "tools/status/snapshot.hpp"
#include "tools/status/text_line.hpp"

namespace rover::status {

// OK, DEGRADED, FAULT: as reported. stopped: not needed at this level; dead: no process; stale: no HEARTBEAT for 1 s;
// silent: never any; waiting: no tick yet.
Piece condition_of(const ServiceStatus& service);
Colour colour_of_state(const std::string& state);
// True if a periodic channel has stopped.
bool is_stale(const ChannelStatus& channel);

}  // namespace rover::status
