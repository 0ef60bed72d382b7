// Standard output: a terminal, with colours and redrawing in place, or a plain file.
#pragma once

#include "status/snapshot.hpp"

namespace rover::status {

// One screen, whatever the height of the terminal.
void print_once(const Snapshot& snapshot);

// Redraws in place and hides the cursor as long as it lives; into a file it writes one screen after the other.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  void redraw(const Snapshot& snapshot);

 private:
  bool terminal_;
};

}  // namespace rover::status
