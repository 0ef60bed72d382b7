// The s6 scan directory of a run: one service directory with its log for each executable.
#pragma once

#include <string>
#include <vector>

#include "launcher/run_folder.hpp"

namespace rover {

struct ServiceCommand {
  std::string name;
  std::string command;  // executed by sh, in the run's folder
  bool once = false;    // not started again after a clean exit
};

// A service of `folder`'s run as the launcher starts it.
ServiceCommand service_command(const std::string& name, const std::string& bin_dir, const RunFolder& folder,
                               bool allow_injection);

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

// A service that ended for good with an error.
struct FailedService {
  std::string name;
  std::string said;  // the last line of its log, empty while that lags behind
  std::string line() const { return said.empty() ? name + ": ended with exit status 2" : said; }
};
// Those that have said why come first, in the order of their names.
std::vector<FailedService> failed_services(const std::string& run_dir);

}  // namespace rover
