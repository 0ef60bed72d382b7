// rover_export LOG: a log in the formats of other tools.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "common/bus/command_line.hpp"
#include "interchange/export_log.hpp"

int main(int argc, char** argv) {
  rover::interchange::ExportOptions options;
  std::vector<std::string> formats, channels;
  CLI::App app(
      "./rover export: a log as CSV tables, TUM trajectories, GeoJSON tracks and MCAP. Example:\n"
      "./rover export logs/RUN --format tum,mcap");
  app.name("./rover export");
  app.add_option("log", options.log, "an LCM log, or the folder of a run")->required();
  app.add_option("--out", options.out, "folder, new; default: export beside the log");
  app.add_option("--format", formats, "of csv, tum, geojson, mcap; default: all")->delimiter(',');
  app.add_option("--channels", channels, "these alone; default: all")->delimiter(',');
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  if (!formats.empty()) options.formats = {formats.begin(), formats.end()};
  options.channels = {channels.begin(), channels.end()};
  const std::filesystem::path log(options.log);
  const bool is_folder = std::filesystem::is_directory(log);
  if (options.out.empty())
    options.out = is_folder ? log / "export" : log.parent_path() / (log.stem().string() + "_export");
  try {
    for (const std::string& line : rover::interchange::export_log(options)) std::printf("%s\n", line.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
