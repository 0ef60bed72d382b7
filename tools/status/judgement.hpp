// What deserves attention: the words and colours of the screen, from the figures.
#pragma once

#include <string>

#include "tools/status/snapshot.hpp"
#include "tools/status/text_line.hpp"

namespace rover::status {

// OK, DEGRADED, FAULT by its own word; dead: no process; stale: no sign of life for 1 s; silent: none heard at all in
// more than that; waiting: none heard yet, as before the first tick or while no tick comes.
Piece condition_of(const ServiceStatus& service);
Colour colour_of_state(const std::string& state);
// Whether a channel with a rate has gone silent.
bool is_stale(const ChannelStatus& channel);

}  // namespace rover::status
