// Clean shutdown at SIGINT and SIGTERM.
#pragma once

namespace rover {

// SIGINT and SIGTERM make keep_running() false instead of ending the process.
void catch_interrupts();
bool keep_running();

}  // namespace rover
