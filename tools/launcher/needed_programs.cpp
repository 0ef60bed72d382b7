#include "tools/launcher/needed_programs.hpp"

#include <filesystem>

#include "common/bus/config.hpp"

namespace rover {
namespace {

std::string level_of(const std::string& scenario) try {
  const Config config = Config::load(scenario);
  return config.has("level") ? config.text("level") : "efficient";
} catch (const ConfigError&) {
  return "efficient";
}

}  // namespace

bool needs_full_level(const RunArguments& run) {
  if (run.perception != "rendered") return true;
  return (run.level.empty() ? level_of(scenario_file(run)) : run.level) != "efficient";
}

bool needs_full_level(const DriveArguments& drive) {
  return drive.level != "efficient";
}

bool needs_full_level(const ReplayArguments& replay) {
  const std::filesystem::path log(replay.log);
  const auto dir = std::filesystem::is_directory(log) ? log : log.parent_path();
  return std::filesystem::exists(dir / "services" / "slam");
}

}  // namespace rover
