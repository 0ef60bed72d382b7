// Reads single key presses from the terminal, without Enter.
#pragma once

#include <termios.h>

#include <optional>

namespace rover::replay {

enum class Key { kPause, kForward, kBack, kFaster, kSlower, kQuit };

class Keyboard {
 public:
  // Sets the terminal to raw mode until destruction, if standard input is a terminal.
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  bool there() const { return there_; }
  // The next key in the queue, if any.
  std::optional<Key> take() const;

 private:
  bool there_ = false;
  termios before_{};
};

}  // namespace rover::replay
