#include "tools/status/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

namespace rover::status {

bool on_terminal() {
  return isatty(STDOUT_FILENO) == 1;
}

Terminal::Terminal() : terminal_(on_terminal()) {
  if (terminal_) std::fputs("\033[?25l\033[2J", stdout);
}

Terminal::~Terminal() {
  if (terminal_) std::fputs("\033[0m\033[?25h", stdout);
  std::fflush(stdout);
}

// Keep one row free: a newline in the last row would scroll the screen.
ScreenOptions Terminal::options() const {
  ScreenOptions options{.colours = terminal_};
  winsize size{};
  if (!terminal_ || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row < 2 || size.ws_col == 0) return options;
  options.rows = size.ws_row - size_t{1};
  options.columns = size.ws_col;
  return options;
}

void Terminal::redraw(std::string screen) {
  if (!terminal_) {
    std::printf("%s\n", screen.c_str());
  } else {
    for (size_t at = screen.find('\n'); at != std::string::npos; at = screen.find('\n', at + 4))
      screen.insert(at, "\033[K");
    std::printf("\033[H%s\033[J", screen.c_str());
  }
  std::fflush(stdout);
}

}  // namespace rover::status
