// For commands that go on until Ctrl-C.
#pragma once

namespace rover::status {

// From now on SIGINT and SIGTERM end going() and not the process.
void catch_interrupts();
bool going();
// Seconds of a steady clock.
double wall_s();

}  // namespace rover::status
