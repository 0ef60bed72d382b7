#include "status/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "status/screen.hpp"

namespace rover::status {
namespace {

bool on_terminal() {
  return isatty(STDOUT_FILENO) == 1;
}

// One row stays free: a newline in the last one would move the whole screen.
ScreenOptions fitting() {
  ScreenOptions options{.colours = true};
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row < 2 || size.ws_col == 0) return options;
  options.rows = size.ws_row - size_t{1};
  options.columns = std::min<size_t>(options.columns, size.ws_col);
  return options;
}

}  // namespace

void print_once(const Snapshot& snapshot) {
  std::fputs(screen(snapshot, {.colours = on_terminal()}).c_str(), stdout);
}

Terminal::Terminal() : terminal_(on_terminal()) {
  if (terminal_) std::fputs("\033[?25l\033[2J", stdout);
}

Terminal::~Terminal() {
  if (terminal_) std::fputs("\033[0m\033[?25h", stdout);
  std::fflush(stdout);
}

void Terminal::redraw(const Snapshot& snapshot) {
  if (!terminal_) {
    std::printf("%s\n", screen(snapshot, {}).c_str());
  } else {
    std::string text = screen(snapshot, fitting());
    for (size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 4)) text.insert(at, "\033[K");
    std::printf("\033[H%s\033[J", text.c_str());
  }
  std::fflush(stdout);
}

}  // namespace rover::status
