// The s6 scan directory of a run: one service directory with its log for each executable.
#pragma once

#include <string>
#include <vector>

namespace rover {

struct ServiceCommand {
  std::string name;
  std::string command;    // executed by sh, in the run's folder
  bool once = false;      // not started again after a clean exit
};

void write_s6_tree(const std::string& run_dir, const std::vector<ServiceCommand>& services);

// Keeps s6-svscan on a run's tree as a child that dies with this process.
class S6Session {
 public:
  explicit S6Session(const std::string& run_dir);
  ~S6Session();
  S6Session(const S6Session&) = delete;
  S6Session& operator=(const S6Session&) = delete;
  // Stops every service and waits until all have gone.
  void stop();
  bool running();

 private:
  std::string run_dir_;
  int pid_ = -1;
};

// The last line of the log of each service that ended for good with an error, "name: what"; empty where none has. All
// logs are written only when the session has stopped.
std::vector<std::string> failed_services(const std::string& run_dir);

}  // namespace rover
