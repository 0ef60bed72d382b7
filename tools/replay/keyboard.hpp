// Single keys from the terminal, without Enter.
#pragma once

#include <termios.h>

#include <optional>

namespace rover::replay {

enum class Key { kPause, kForward, kBack, kFaster, kSlower, kQuit };

class Keyboard {
 public:
  // Takes the terminal over until the end of the object, where standard input is one.
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  bool there() const { return there_; }
  // A key that waits.
  std::optional<Key> take() const;

 private:
  bool there_ = false;
  termios before_{};
};

}  // namespace rover::replay
