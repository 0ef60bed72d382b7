#include "tools/replay/keyboard.hpp"

#include <poll.h>
#include <unistd.h>

#include <string_view>

namespace rover::replay {

Keyboard::Keyboard() {
  // A background job must not change the terminal mode.
  if (isatty(STDIN_FILENO) != 1 || tcgetpgrp(STDIN_FILENO) != getpgrp()) return;
  if (tcgetattr(STDIN_FILENO, &before_) != 0) return;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  there_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

Keyboard::~Keyboard() {
  if (there_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::optional<Key> Keyboard::take() const {
  if (!there_) return std::nullopt;
  char text[8] = {};
  const ssize_t count = read(STDIN_FILENO, text, sizeof text - 1);  // the three bytes of an arrow key arrive together
  const std::string_view key(text, count > 0 ? static_cast<size_t>(count) : 0);
  if (key == " ") return Key::kPause;
  if (key == "\033[C") return Key::kForward;
  if (key == "\033[D") return Key::kBack;
  if (key == "+" || key == "\033[A") return Key::kFaster;
  if (key == "-" || key == "\033[B") return Key::kSlower;
  if (key == "q") return Key::kQuit;
  return std::nullopt;
}

}  // namespace rover::replay
