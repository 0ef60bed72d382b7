#include "tools/campaign/campaign_file.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "common/bus/user_files.hpp"
#include "common/bus/yaml_file.hpp"
#include "common/core/decimal.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "tools/campaign/axes.hpp"
#include "tools/launcher/arguments.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxDrives = 1'000'000;
const std::set<std::string> kBlockKeys = {"scenario", "seeds", "axes"};

using AxisValues = std::map<std::string, std::vector<std::string>>;

struct Block {
  std::vector<std::string> scenarios;
  std::vector<std::int64_t> seeds;
  AxisValues axes;
};

class Reader {
 public:
  Reader(std::string file, std::string config_dir) : file_(std::move(file)), config_dir_(std::move(config_dir)) {}

  std::vector<Block> read() const {
    const YAML::Node root = load_yaml(file_);
    check_keys(root, "", {"scenario", "seeds", "axes", "blocks"});
    Block common;
    read_block(root, "", common);
    std::vector<Block> blocks;
    if (const YAML::Node list = root["blocks"]) {
      if (!list.IsSequence() || list.size() == 0) fail(list, "blocks", "a list of blocks is expected");
      for (const YAML::Node& node : list) {
        const std::string prefix = "blocks[" + std::to_string(blocks.size()) + "].";
        check_keys(node, prefix, kBlockKeys);
        blocks.push_back(common);
        read_block(node, prefix, blocks.back());
        check_complete(blocks.back(), node, prefix);
      }
    } else {
      blocks.push_back(common);
      check_complete(common, root, "");
    }
    return blocks;
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& key, const std::string& what) const {
    throw ConfigError(file_ + ":" + std::to_string(node.Mark().line + 1) + ": " + key + ": " + what);
  }

  void check_keys(const YAML::Node& node, const std::string& prefix, const std::set<std::string>& known) const {
    if (!node.IsMap()) fail(node, prefix.empty() ? "campaign" : prefix, "a mapping of keys to values is expected");
    for (const auto& entry : node)
      if (!known.contains(entry.first.Scalar())) fail(entry.first, prefix + entry.first.Scalar(), "unknown key");
  }

  void check_complete(const Block& block, const YAML::Node& node, const std::string& prefix) const {
    if (block.scenarios.empty()) fail(node, prefix + "scenario", "missing");
    if (block.seeds.empty()) fail(node, prefix + "seeds", "missing");
    if (block.axes.contains("slope_direction") && !block.axes.contains("slope_deg"))
      fail(node, prefix + "axes.slope_direction", "requires the axis slope_deg");
    for (const std::string& scenario : block.scenarios)
      if (block.axes.contains("slope_deg") && !load_yaml(scenario)["world"]["plane"])
        fail(node, prefix + "axes.slope_deg", scenario + " has no plane (world.plane) that could slope");
  }

  void read_block(const YAML::Node& node, const std::string& prefix, Block& block) const {
    if (const YAML::Node scenario = node["scenario"]) block.scenarios = scenarios(scenario, prefix + "scenario");
    if (const YAML::Node seeds = node["seeds"]) block.seeds = read_seeds(seeds, prefix + "seeds");
    const YAML::Node axes = node["axes"];
    if (!axes) return;
    if (!axes.IsMap()) fail(axes, prefix + "axes", "a mapping of axes to lists of values is expected");
    for (const auto& entry : axes) {
      const std::string name = entry.first.Scalar();
      block.axes[name] = axis_values(entry.first, entry.second, prefix + "axes." + name);
    }
  }

  // A list of single values, or one.
  std::vector<YAML::Node> items(const YAML::Node& node, const std::string& key) const {
    if (node.IsScalar()) return {node};
    if (!node.IsSequence()) fail(node, key, "a list of values is expected");
    if (node.size() == 0) fail(node, key, "an empty list");
    std::vector<YAML::Node> values;
    for (const YAML::Node& item : node) {
      if (!item.IsScalar()) fail(item, key, "a list of single values is expected");
      values.push_back(item);
    }
    return values;
  }

  std::vector<std::string> scenarios(const YAML::Node& node, const std::string& key) const {
    std::vector<std::string> files;
    for (const YAML::Node& item : items(node, key)) {
      const fs::path path = item.Scalar().starts_with("~") ? fs::path(user_path(item.Scalar()))
                                                           : fs::path(file_).parent_path() / item.Scalar();
      const std::string file = fs::absolute(path).lexically_normal();
      if (const std::string problem = file_problem(file); !problem.empty()) fail(item, key, file + ": " + problem);
      try {
        load_scenario(file);
      } catch (const ConfigError& error) {
        fail(item, key, error.what());
      }
      files.push_back(file);
    }
    return files;
  }

  std::vector<std::int64_t> read_seeds(const YAML::Node& node, const std::string& key) const {
    std::string text;
    for (const YAML::Node& item : items(node, key)) text += (text.empty() ? "" : ",") + item.Scalar();
    try {
      return parse_seeds(text);
    } catch (const ConfigError&) {
      fail(node, key, "'" + text + "' is neither a range like 1..20 (of 10,000 at most) nor a list like [1, 4, 7]");
    }
  }

  std::vector<std::string> axis_values(const YAML::Node& name, const YAML::Node& node, const std::string& key) const {
    const Axis* axis = find_axis(name.Scalar());
    if (axis == nullptr && !is_parameter(name.Scalar())) fail(name, key, unknown_axis());
    std::vector<std::string> values;
    for (const YAML::Node& item : items(node, key)) {
      const std::string problem = axis != nullptr ? value_problem(*axis, item.Scalar())
                                                  : parameter_problem(config_dir_, name.Scalar(), item.Scalar());
      if (!problem.empty()) fail(item, key, problem);
      values.push_back(short_value(item.Scalar()));
    }
    return values;
  }

  static std::string unknown_axis() {
    std::string names;
    for (const Axis& axis : axes()) names += axis.name + ", ";
    return "unknown axis; known: " + names + "and parameters as slam.map.cell_m";
  }

  std::string file_;
  std::string config_dir_;
};

// Flat ground has no direction: such cells are one.
Cell merged(Cell cell) {
  const auto slope = cell.find("slope_deg");
  if (slope != cell.end() && slope->second == "0" && cell.contains("slope_direction")) cell["slope_direction"] = "flat";
  return cell;
}

// Of a scenario's file; cells and the files of their worlds are called by it.
std::string base_name(const std::string& scenario) {
  return fs::path(scenario).stem();
}

std::vector<Cell> product(const std::string& scenario, const AxisValues& axes) {
  std::vector<Cell> cells = {{{"scenario", base_name(scenario)}}};
  for (const auto& [axis, values] : axes) {
    std::vector<Cell> more;
    for (const Cell& cell : cells)
      for (const std::string& value : values) (more.emplace_back(cell))[axis] = value;
    cells = std::move(more);
    if (cells.size() > kMaxDrives) break;  // refused by the caller
  }
  return cells;
}

}  // namespace

CampaignFile load_campaign(const std::string& file, const std::string& config_dir) {
  CampaignFile campaign{fs::path(file).stem().string(), {}};
  std::map<std::string, std::string> bases;  // name in a cell, and file
  std::set<std::pair<Cell, std::int64_t>> seen;
  std::vector<std::pair<size_t, Drive>> ordered;  // index of the seed in its block
  for (const Block& block : Reader(file, config_dir).read()) {
    for (const std::string& scenario : block.scenarios) {
      const std::string& base = bases.emplace(base_name(scenario), scenario).first->second;
      if (base != scenario)
        throw ConfigError(file + ": scenario: " + scenario + " and " + base + " have the same name");
      for (const Cell& product_cell : product(scenario, block.axes)) {
        const Cell cell = merged(product_cell);
        for (size_t i = 0; i < block.seeds.size(); ++i) {
          if (seen.emplace(cell, block.seeds[i]).second) ordered.emplace_back(i, Drive{scenario, cell, block.seeds[i]});
          if (ordered.size() > kMaxDrives)
            throw ConfigError(file + ": more than " + std::to_string(kMaxDrives) + " drives");
        }
      }
    }
  }
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [index, drive] : ordered) campaign.drives.push_back(std::move(drive));
  return campaign;
}

}  // namespace rover::campaign
