// Speaks to s6, which keeps the services: what it kills it starts anew.
#pragma once

#include <string>

namespace rover {

// Whether a process of that number is there: a hung one is, a crashed one is not.
bool process_alive(int pid);
// What it has computed so far; 0 where there is no such process.
double process_cpu_s(int pid);
// Whether the run has this service.
bool keeps_service(const std::string& run_dir, const std::string& service);
// `option` of s6-svc(8), to the service of the run's folder. False where s6 does not keep such a service.
bool control_service(const std::string& run_dir, const std::string& service, const char* option);
// SIGKILL to the service of the run's folder: a hung or stopped process obeys nothing less. False where s6 does not
// keep such a service.
bool kill_service(const std::string& run_dir, const std::string& service);

}  // namespace rover
