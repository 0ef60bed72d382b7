// HTTP routes of the page: files, event stream, images and operator commands.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mission_control/broadcaster.hpp"
#include "mission_control/config.hpp"
#include "mission_control/http_server.hpp"
#include "mission_control/image_cache.hpp"
#include "mission_control/run_map.hpp"

namespace rover::mission {

// Properties of the run that the page shows.
struct PageContext {
  std::string run_dir;   // holds orbital_map.tif; empty: no map
  std::string run_name;  // changes with the run, not with a restart of the service
  bool allow_injection = false;
  std::vector<std::string> services;
  double rover_length_m = 1.75;
  nlohmann::json setup;
  // Injects a process fault; false if impossible.
  std::function<bool(const std::string& service, CommandKind kind)> inject;
};

class PageServer {
 public:
  PageServer(PageConfig config, PageContext context, SharedState& shared, lcm::LCM& bus);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  // Retries every second while the address is in use.
  void start();
  // Call every tick in the bus thread.
  void update() { subscriber_.update(wall_seconds()); }
  bool serving() const { return server_.serving(); }

 private:
  void add_files();
  void add_state();
  void add_pictures();
  void add_commands();
  Response stream(const Request& request);
  Response command(const Request& request);
  Response submit(const Command& command);
  Response inject(const Command& command);
  Response check(const Request& request);
  std::string path_problem(const Command& command);
  nlohmann::json setup();
  nlohmann::json history();
  nlohmann::json camera();

  PageConfig config_;
  PageContext context_;
  SharedState& shared_;
  PageClients clients_;
  TelemetrySubscriber subscriber_;
  ImageCache images_;
  RunMap map_;
  HttpServer server_;
  Broadcaster broadcaster_;  // declared last: its thread wakes the server
};

}  // namespace rover::mission
