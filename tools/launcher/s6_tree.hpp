// The s6 scan directory of a run: one service directory with its log for each executable.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/run_folder.hpp"

namespace rover {

struct ServiceCommand {
  std::string name;   // of the executable too
  std::string flags;  // beside those that all services take; words of our own alone, a shell reads them
  bool once = false;  // not started again after a clean exit
};

// The scripts hold no text of the user's: folders and bus come by the environment that S6Session gives them.
void write_s6_tree(const std::string& run_dir, const std::vector<ServiceCommand>& services, bool allow_injection);

// Keeps s6-svscan on a run's tree as a child that dies with this process.
class S6Session {
 public:
  // The executables lie in `bin_dir`.
  S6Session(const RunFolder& folder, const std::string& bin_dir);
  ~S6Session();
  S6Session(const S6Session&) = delete;
  S6Session& operator=(const S6Session&) = delete;
  // Stops every service and waits until all have gone.
  void stop();
  bool running();

 private:
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
