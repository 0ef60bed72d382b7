#include "tools/campaign/engine.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "common/bus/config.hpp"
#include "tools/campaign/gnu_parallel.hpp"
#include "tools/campaign/slurm.hpp"

namespace rover::campaign {
namespace {

struct Kind {
  const char* name;
  const char* program;
  const char* package;
  std::unique_ptr<Engine> (*make)();
};
const Kind kKinds[] = {
    {"parallel", "parallel", "parallel", [] { return std::unique_ptr<Engine>(new GnuParallel); }},
    {"slurm", "sbatch", "slurm-client", [] { return std::unique_ptr<Engine>(new Slurm); }},
};

bool is_installed(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

std::unique_ptr<Engine> make_engine(const std::string& name) {
  for (const Kind& kind : kKinds) {
    if (kind.name != name) continue;
    if (!is_installed(kind.program))
      throw ConfigError("--engine " + name + ": the program '" + kind.program +
                        "' is not installed; Debian has it in the package " + kind.package);
    return kind.make();
  }
  throw ConfigError("--engine " + name + ": no such engine");
}

void end_left_jobs(const std::string& work) {
  if (is_installed("scancel")) Slurm::cancel_left(work);
}

}  // namespace rover::campaign
