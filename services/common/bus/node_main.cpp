#include "common/bus/node_main.hpp"

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>

#include "common/bus/bus_url.hpp"
#include "common/bus/command_line.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/navigation_config.hpp"

namespace rover {
namespace {

// A damaged length in a message then causes an exception instead of exhausting the memory.
void limit_memory() {
  constexpr rlim_t kLimit = rlim_t{6} << 30;
  const rlimit limit{kLimit, kLimit};
  setrlimit(RLIMIT_AS, &limit);
}

}  // namespace

std::int64_t boot_id_from_clock() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string load_bus_url(const std::string& config_dir) {
  const Config config = Config::load(config_dir + "/bus.yaml");
  const std::string url = config.text("url");
  if (const std::string problem = bus_url_problem(url); !problem.empty()) config.fail("url", problem);
  config.finish();
  return url;
}

int node_main(int argc, char** argv, const std::string& service, const ConfigLoader& describe,
              const NodeFactory& factory) {
  NodeOptions options;
  options.name = service;
  options.boot_id = boot_id_from_clock();
  std::string config_dir = project_dir() + "/config";
  std::string bus;
  std::string parameters;
  CLI::App app(service + ": a service of the rover");
  app.add_option("--config", config_dir, "configuration folder")->capture_default_str();
  app.add_option("--bus", bus, "LCM URL instead of the one in bus.yaml");
  app.add_option("--boot-id", options.boot_id, "boot number; larger at each start");
  app.add_option("--run-dir", options.run_dir, "folder of checkpoints");
  app.add_flag("--allow-injection", options.allow_injection, "apply the faults of INJECT");
  app.add_option("--mute", options.muted, "channels to ignore");
  app.add_option("--parameters", parameters, "print all parameters with their defaults and exit")
      ->check(CLI::IsMember({"text", "yaml", "markdown"}));
  try {
    parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_parse(app, error);
  }
  catch_interrupts();
  std::signal(SIGPIPE, SIG_IGN);
  limit_memory();
  bool started = false;
  try {
    if (!parameters.empty()) {
      ParameterList list;
      describe(config_dir, &list);
      std::printf("%s", to_format(list, parameters).c_str());
      return 0;
    }
    options.cpu_scale = load_navigation(config_dir).cpu_scale;
    if (bus.empty()) bus = load_bus_url(config_dir);
    lcm::LCM lcm(bus);
    lcm::LCM reports(reports_url(bus));
    if (!lcm.good() || !reports.good()) throw ConfigError("bus: cannot join " + bus);
    Node node(options, lcm, parse_udpm(bus) ? &reports : nullptr);
    const std::shared_ptr<void> keep = factory({node, config_dir});
    if (const auto address = parse_udpm(bus)) node.close_subscriptions(address->port);
    node.log("INFO", "STARTED boot=" + std::to_string(options.boot_id));
    started = true;
    node.run(keep_running);
    node.log("INFO", "STOPPED");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", service.c_str(), error.what());
    return started ? 1 : 2;
  }
  return 0;
}

}  // namespace rover
