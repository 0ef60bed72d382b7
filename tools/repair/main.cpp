// rover_repair LOG: repairs a damaged log.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/bus/command_line.hpp"
#include "common/bus/interrupt.hpp"
#include "tools/repair/repair.hpp"

int main(int argc, char** argv) {
  rover::recorder::RepairArguments repair;
  CLI::App app(
      "Copies every intact message of a truncated or damaged log. The log is not changed unless --in-place is given.\n"
      "Example: ./rover repair logs/RUN/traverse.lcm");
  app.name("./rover repair");
  app.add_option("log", repair.log, "log file or run folder")->required()->transform(rover::is_user_path());
  CLI::Option* out = app.add_option("--out", repair.out, "output file; default: NAME.repaired.lcm beside the log")
                         ->transform(rover::is_user_path());
  app.add_flag("--in-place", repair.in_place, "replace the damaged log")->excludes(out);
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  rover::catch_interrupts();
  try {
    rover::recorder::repair(repair);
  } catch (const std::exception& error) {  // ConfigError, or an error of the file system
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
