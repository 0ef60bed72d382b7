// For processes that go on until they are told to end.
#pragma once

namespace rover {

// From now on SIGINT and SIGTERM end going() and not the process.
void catch_interrupts();
bool going();

}  // namespace rover
