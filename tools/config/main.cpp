// rover_config: prints every parameter; writes or checks the files made from their descriptions.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "common/bus/command_line.hpp"
#include "common/bus/text_file.hpp"
#include "tools/config/parameter_files.hpp"

namespace {

using namespace rover;
using namespace rover::config_tool;

void write(const MadeFile& made) {
  std::ofstream out(made.file, std::ios::trunc);
  out << made.content;
  out.flush();
  if (!out) throw ConfigError(made.file + ": cannot be written");
}

bool is_current(const MadeFile& made) {
  constexpr size_t kMaxFile = 1 << 20;
  if (std::filesystem::exists(made.file) && read_text(made.file, kMaxFile) == made.content) return true;
  std::fprintf(stderr, "%s: not what its description makes; ./rover config --write mends it\n", made.file.c_str());
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names;
  std::string format = "text";
  bool writes = false;
  bool checks = false;
  CLI::App app(
      "Every parameter with its default, unit, range and meaning.\n"
      "Example: ./rover config slam");
  app.name("./rover config");
  app.add_option("name", names, "a service, orbital_planner or navigation; default: all")
      ->check(CLI::IsMember(parameter_files()));
  app.add_option("--format", format, "text, yaml or markdown")->check(CLI::IsMember({"text", "yaml", "markdown"}));
  CLI::Option* format_option = app.get_option("--format");
  CLI::Option* write_flag = app.add_flag(
      "--write", writes, "write config/*.yaml and the READMEs' tables of this checkout from the descriptions");
  app.add_flag("--check", checks, "exit with 1 if one of these files differs")
      ->excludes(write_flag)
      ->excludes(format_option);
  write_flag->excludes(format_option);
  try {
    parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_parse(app, error);
  }
  if (names.empty()) names = parameter_files();
  bool current = true;
  try {
    for (const std::string& name : names) {
      if (!writes && !checks) {
        std::printf("%s%s", name == names.front() ? "" : "\n", parameters_of(name, format).c_str());
        continue;
      }
      for (const MadeFile& made : made_files(project_dir(), name)) {
        if (writes) write(made);
        current = is_current(made) && current;
      }
    }
  } catch (const std::exception& error) {  // ConfigError, or an error of the file system
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return current ? 0 : 1;
}
