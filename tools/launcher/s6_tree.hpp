// The s6 scan directory of a run, with one service directory and log per executable.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/run_folder.hpp"

namespace rover {

struct ServiceCommand {
  std::string name;   // also the executable
  std::string flags;  // extra flags; no user text, because a shell reads them
  bool once = false;  // no restart after a clean exit
};

// The scripts contain no user text; S6Session passes folders and bus by the environment.
void write_s6_tree(const std::string& run_dir, const std::vector<ServiceCommand>& services, bool allow_injection);

// Runs s6-svscan as a child process that dies with this process.
class S6Session {
 public:
  // `bin_dir` contains the executables.
  S6Session(const RunFolder& folder, const std::string& bin_dir);
  ~S6Session();
  S6Session(const S6Session&) = delete;
  S6Session& operator=(const S6Session&) = delete;
  // Stops all services and waits for them.
  void stop();
  bool running();

 private:
  int pid_ = -1;
};

// A service that failed and is not restarted.
struct FailedService {
  std::string name;
  std::string last_log_line;  // last line of its log; empty until the logger has written it
  std::string line() const { return last_log_line.empty() ? name + ": ended with exit status 2" : last_log_line; }
};
// Services with a log line first, then by name.
std::vector<FailedService> failed_services(const std::string& run_dir);

}  // namespace rover
