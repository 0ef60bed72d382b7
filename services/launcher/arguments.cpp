#include "launcher/arguments.hpp"

#include <filesystem>
#include <regex>
#include <sstream>

#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"

namespace rover {

std::string scenario_file(const RunArguments& arguments) {
  return arguments.scenario.empty() ? arguments.source_dir + "/config/scenarios/default.yaml" : arguments.scenario;
}

std::string scenario_name(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

std::string commit_of(const std::string& source_dir) {
  std::string commit =
      output_of({"git", "-C", source_dir, "describe", "--always", "--dirty", "--abbrev=12"}).value_or("");
  while (!commit.empty() && commit.back() == '\n') commit.pop_back();
  return commit.empty() ? "unknown" : commit;
}

std::vector<std::int64_t> parse_seeds(const std::string& text) {
  static const std::regex range(R"((\d{1,9})\.\.(\d{1,9}))");
  static const std::regex list(R"(\d{1,9}(,\d{1,9})*)");
  std::vector<std::int64_t> seeds;
  std::smatch match;
  if (std::regex_match(text, match, range)) {
    for (std::int64_t seed = std::stoll(match[1]); seed <= std::stoll(match[2]); ++seed) seeds.push_back(seed);
  } else if (std::regex_match(text, list)) {
    std::istringstream items(text);
    for (std::string item; std::getline(items, item, ',');) seeds.push_back(std::stoll(item));
  }
  if (seeds.empty()) throw ConfigError("--seeds: '" + text + "' is neither a range like 1..10 nor a list like 1,4,7");
  return seeds;
}

}  // namespace rover
