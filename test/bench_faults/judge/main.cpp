// Evaluates a log of the bench and writes its table. Exit status 1 if a requirement is not met.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "test/bench_faults/judge/table.hpp"

int main(int argc, char** argv) {
  using namespace rover::bench_faults;
  std::string config = "config", log = "logs/bench/faults/stack/stack.lcm", out;
  Heading heading;
  CLI::App app("evaluates a log of fault_stack");
  app.add_option("--config", config, "configuration folder")->capture_default_str();
  app.add_option("--log", log)->capture_default_str();
  app.add_option("--out", out, "output file of the table")->required();
  app.add_option("--command", heading.command);
  app.add_option("--commit", heading.commit);
  app.add_option("--machine", heading.machine);
  CLI11_PARSE(app, argc, argv);
  const Settings settings = read_settings(config);
  Judge judge(settings);
  lcm::LogFile file(log, "r");
  if (!file.good()) {
    std::cerr << "fault_judge: " << log << ": cannot be read\n";
    return 2;
  }
  while (const lcm::LogEvent* event = file.readNextEvent())
    judge.take(event->channel, static_cast<const std::uint8_t*>(event->data), event->datalen);
  judge.finish();
  std::ofstream table(out);
  return write_table(heading, settings, judge, table) ? 0 : 1;
}
