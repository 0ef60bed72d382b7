#include "common/bus/interrupt.hpp"

#include <csignal>

namespace rover {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt(int) {
  interrupted = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = interrupt;  // without SA_RESTART: blocking calls return
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool keep_running() {
  return interrupted == 0;
}

}  // namespace rover
