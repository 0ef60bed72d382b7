// rover_export LOG: converts a log to formats of other tools.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/bus/command_line.hpp"
#include "common/bus/interrupt.hpp"
#include "tools/interchange/export_log.hpp"

int main(int argc, char** argv) {
  rover::interchange::ExportOptions options;
  std::vector<std::string> formats, channels;
  CLI::App app(
      "./rover export: a log as CSV tables, TUM trajectories, GeoJSON tracks and MCAP. Example:\n"
      "./rover export logs/RUN --format tum,mcap");
  app.name("./rover export");
  app.add_option("log", options.log, "log file or run folder")->required()->transform(rover::is_user_path());
  rover::add_log_run(app, options.log_run);
  app.add_option("--out", options.out, "folder, new or empty; default: export beside the log")
      ->transform(rover::is_user_path());
  rover::repeatable(app.add_option("--format", formats, "of csv, tum, geojson, mcap; default: all"))->delimiter(',');
  rover::repeatable(app.add_option("--channels", channels, "only these channels; default: all"))->delimiter(',');
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  if (!formats.empty()) options.formats = {formats.begin(), formats.end()};
  options.channels = {channels.begin(), channels.end()};
  rover::catch_interrupts();
  try {
    for (const std::string& line : rover::interchange::export_log(options)) std::printf("%s\n", line.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
