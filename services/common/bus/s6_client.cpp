#include "common/bus/s6_client.hpp"

#include <signal.h>
#include <time.h>

#include <cerrno>
#include <filesystem>

#include "common/bus/child_process.hpp"

namespace rover {

bool process_alive(int pid) {
  return pid > 0 && (kill(pid, 0) == 0 || errno == EPERM);
}

double process_cpu_s(int pid) {
  clockid_t clock{};
  timespec used{};
  if (pid <= 0 || clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0.0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

bool keeps_service(const std::string& run_dir, const std::string& service) {
  return !run_dir.empty() && std::filesystem::exists(run_dir + "/services/" + service);
}

bool control_service(const std::string& run_dir, const std::string& service, const char* option) {
  if (!keeps_service(run_dir, service)) return false;
  return run_program({"s6-svc", option, run_dir + "/services/" + service}) == 0;
}

bool kill_service(const std::string& run_dir, const std::string& service) {
  return control_service(run_dir, service, "-k");
}

}  // namespace rover
