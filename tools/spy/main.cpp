// rover_spy: shows every channel of a bus or a log as text.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/bus/command_line.hpp"
#include "common/bus/config.hpp"
#include "tools/spy/spy_command.hpp"

int main(int argc, char** argv) {
  rover::spy::SpyArguments spy;
  spy.target.logs_dir = rover::project_dir() + "/logs";
  std::vector<std::string> channels;
  CLI::App app(
      "Shows every channel of the bus, or of a log: rate, age, gaps, volume and fields.\n"
      "Examples: ./rover spy --channel POSE       ./rover spy logs/RUN/traverse.lcm");
  app.name("./rover spy");
  app.add_option("log", spy.log, "log file or run folder; default: the bus of the running run")
      ->transform(rover::is_user_path());
  rover::add_log_run(app, spy.log_run);
  rover::repeatable(app.add_option("--channel", channels, "show all fields of this channel; repeatable"));
  app.add_flag("--once", spy.once, "listen for 1.2 s, print once and exit");
  app.add_option("--for", spy.for_s, "stop after this many seconds")->check(CLI::Range(0.1, 1e6));
  app.add_flag("--json", spy.json, "print one JSON document, after 1.2 s or after --for");
  app.add_option("--run", spy.target.run, "run folder; default: the newest running one in logs/")
      ->transform(rover::is_user_path());
  app.add_option("--bus", spy.target.bus, "LCM URL; default: the run's")->check(rover::is_bus_url());
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  spy.channels = {channels.begin(), channels.end()};
  try {
    return rover::spy::spy(spy);
  } catch (const rover::ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
