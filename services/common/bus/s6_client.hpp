// Controls services through s6, which restarts them.
#pragma once

#include <string>

namespace rover {

// Whether the process exists, hung or not.
bool process_alive(int pid);
// CPU time used so far; 0 if there is no such process.
double process_cpu_s(int pid);
// Whether the run has this service.
bool keeps_service(const std::string& run_dir, const std::string& service);
// Applies an option of s6-svc(8) to the service. False if s6 does not supervise it.
bool control_service(const std::string& run_dir, const std::string& service, const char* option);
// SIGKILL, because a hung or stopped process ignores other signals. False if s6 does not supervise the service.
bool kill_service(const std::string& run_dir, const std::string& service);

}  // namespace rover
