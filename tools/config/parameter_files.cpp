#include "tools/config/parameter_files.hpp"

#include <filesystem>

#include "common/bus/child_process.hpp"
#include "common/bus/navigation_config.hpp"
#include "common/bus/service_names.hpp"
#include "common/bus/text_file.hpp"
#include "common/bus/user_files.hpp"

namespace rover::config_tool {
namespace {

constexpr const char* kBegin = "<!-- parameters -->\n";
constexpr const char* kEnd = "<!-- /parameters -->\n";
constexpr const char* kShared = "navigation";
constexpr const char* kTool = "orbital_planner";

std::string readme_of(const std::string& name) {
  if (name == kShared) return "services/common/README.md";
  if (name == "supervisor") return "supervisor/README.md";
  return (name == kTool ? "tools/" : "services/") + name + "/README.md";
}

}  // namespace

std::vector<std::string> parameter_files() {
  std::vector<std::string> names = {kShared};
  for (const std::string& service : service_names(true)) names.push_back(service);
  names.emplace_back(kTool);
  return names;
}

std::string parameters_of(const std::string& name, const std::string& format) {
  const std::string config_dir = project_dir() + "/config";
  if (name == kShared) {
    ParameterList list;
    load_navigation(config_dir, &list);
    return to_format(list, format);
  }
  const std::string program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / (name == kTool ? "rover_" + name : name);
  const auto text = output_of({program, "--config", config_dir, "--parameters", format});
  if (!text) throw ConfigError(program + ": does not list its parameters; ./rover build makes it");
  return *text;
}

std::string with_table(const std::string& text, const std::string& table, const std::string& file) {
  const size_t begin = text.find(kBegin);
  const size_t end = text.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw ConfigError(file + ": has no lines '<!-- parameters -->' and '<!-- /parameters -->' for the table");
  return text.substr(0, begin) + kBegin + table + text.substr(end);
}

std::vector<MadeFile> made_files(const std::string& project, const std::string& name) {
  constexpr size_t kMaxReadme = 1 << 20;
  const std::string readme = project + "/" + readme_of(name);
  return {{project + "/config/" + name + ".yaml", parameters_of(name, "yaml")},
          {readme, with_table(read_text(readme, kMaxReadme), parameters_of(name, "markdown"), readme)}};
}

}  // namespace rover::config_tool
