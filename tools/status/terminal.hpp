// Standard output: a terminal, with colours and redrawing in place, or a plain file.
#pragma once

#include <string>

#include "tools/status/screen.hpp"

namespace rover::status {

bool on_terminal();

// Redraws in place and hides the cursor as long as it lives; into a file it writes one screen after the other.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  // What fits on it; a plain file takes all.
  ScreenOptions options() const;
  // Lines that end with a newline each.
  void redraw(std::string screen);

 private:
  bool terminal_;
};

}  // namespace rover::status
