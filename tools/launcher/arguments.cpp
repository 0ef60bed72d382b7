#include "tools/launcher/arguments.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>

#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"
#include "common/core/decimal.hpp"
#include "common/core/text_hash.hpp"

namespace rover {

std::string scenario_file(const RunArguments& arguments) {
  return arguments.scenario.empty() ? arguments.source_dir + "/config/scenarios/default.yaml" : arguments.scenario;
}

std::string scenario_name(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

std::string commit_of(const std::string& source_dir) {
  std::string commit = output_of({"git", "-C", source_dir, "describe", "--always", "--abbrev=12"}).value_or("");
  while (!commit.empty() && commit.back() == '\n') commit.pop_back();
  if (commit.empty()) return "unknown";
  const std::string changes =
      output_of({"git", "-C", source_dir, "diff", "HEAD", "--", ".", ":(exclude)test/results"}).value_or("");
  if (changes.empty()) return commit;
  char hash[9];
  std::snprintf(hash, sizeof hash, "%08x", static_cast<std::uint32_t>(text_hash(changes)));
  return commit + "-dirty-" + hash;
}

std::vector<std::int64_t> parse_seeds(const std::string& text) {
  constexpr std::int64_t kMaxSeeds = 10'000;
  std::vector<std::int64_t> seeds;
  const size_t dots = text.find("..");
  if (dots != std::string::npos) {
    const auto first = parse_whole_number(text.substr(0, dots));
    const auto last = parse_whole_number(text.substr(dots + 2));
    if (first && last && *first >= 0 && *last >= *first && *last - *first < kMaxSeeds)
      for (std::int64_t seed = *first; seed <= *last; ++seed) seeds.push_back(seed);
  } else {
    std::istringstream items(text + ",");
    for (std::string item; std::getline(items, item, ',');) seeds.push_back(parse_whole_number(item).value_or(-1));
    if (std::any_of(seeds.begin(), seeds.end(), [](std::int64_t seed) { return seed < 0; })) seeds.clear();
  }
  std::set<std::int64_t> seen;
  std::erase_if(seeds, [&](std::int64_t seed) { return !seen.insert(seed).second; });
  if (seeds.empty())
    throw ConfigError("--seeds: '" + text +
                      "' is neither a range like 1..10 (of 10,000 at most) nor a list like 1,4,7");
  return seeds;
}

}  // namespace rover
