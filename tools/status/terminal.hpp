// Output to a terminal (colours, redraw in place) or to a plain file.
#pragma once

#include <string>

#include "tools/status/screen.hpp"

namespace rover::status {

bool on_terminal();

// Redraws in place and hides the cursor until destruction; in a file, screens follow each other.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  // Size of the terminal; unlimited for a file.
  ScreenOptions options() const;
  // `screen`: newline-terminated lines.
  void redraw(std::string screen);

 private:
  bool terminal_;
};

}  // namespace rover::status
