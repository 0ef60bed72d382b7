#include "common/bus/s6_client.hpp"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <time.h>

#include <cerrno>
#include <filesystem>

extern char** environ;

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
  const std::string dir = run_dir + "/services/" + service;
  const char* command[] = {"s6-svc", option, dir.c_str(), nullptr};
  pid_t pid = 0;
  if (posix_spawnp(&pid, command[0], nullptr, nullptr, const_cast<char**>(command), environ) != 0) return false;
  int status = 0;
  return waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool kill_service(const std::string& run_dir, const std::string& service) {
  return control_service(run_dir, service, "-k");
}

}  // namespace rover
