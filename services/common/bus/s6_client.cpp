#include "common/bus/s6_client.hpp"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>

extern char** environ;

namespace rover {

bool process_alive(int pid) {
  return pid > 0 && (kill(pid, 0) == 0 || errno == EPERM);
}

double process_cpu_s(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(file, line);
  const size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return 0.0;
  // proc(5): utime and stime are the 14th and 15th field, the name is the second.
  std::istringstream fields(line.substr(name_end + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
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
