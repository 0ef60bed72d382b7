// Formats the status as one screen of text.
#pragma once

#include <string>

#include "tools/status/snapshot.hpp"

namespace rover::status {

struct ScreenOptions {
  bool colours = false;
  size_t columns = 100;
  size_t rows = 50;  // channels that do not fit are counted, not shown
};

// Newline-terminated lines.
std::string screen(const Snapshot& snapshot, const ScreenOptions& options);

}  // namespace rover::status
