#include "test/mission_control/page_under_test.hpp"

#include <chrono>

#include "common/geo/elevation_raster.hpp"
#include "common/geo/geotiff_writer.hpp"

namespace rover::mission::test {

using namespace std::chrono_literals;

TestServer::TestServer(std::function<void(PageConfig&, PageContext&)> change) : port_(free_port()) {
  // Flat in the south, 20 deg in the north.
  ElevationRaster raster = plane_raster(100.0, 100.0, 1.0, 0.0, 0.0);
  for (int row = 50; row < raster.height; ++row)
    for (int column = 0; column < raster.width; ++column)
      raster.at(column, row) = static_cast<float>(std::tan(0.35) * (row - 50));
  write_geotiff(folder_.file("orbital_map.tif"), raster);
  PageConfig config;
  config.guard.port = port_;
  config.max_pages = 4;
  PageContext context;
  context.run_dir = folder_.path();
  context.run_name = "test";
  context.services = {"stereo", "localization"};
  context.setup = nlohmann::json::object();
  context.inject = [this](const std::string& service, CommandKind kind) {
    const std::lock_guard lock(mutex_);
    injected_.push_back(name(kind) + " " + service);
    return true;
  };
  if (change) change(config, context);
  node_ = std::thread([this] {
    for (std::int64_t id = 1; running_;) {
      const auto waiting = shared_.commands.next();
      if (!waiting) {
        std::this_thread::sleep_for(1ms);
        continue;
      }
      {
        const std::lock_guard lock(mutex_);
        taken_.push_back(waiting->command);
      }
      shared_.commands.set_command_id(waiting->ticket, id);
      shared_.commands.acknowledge(id++, true, "");
    }
  });
  server_ = std::make_unique<PageServer>(config, context, shared_, bus_);
  server_->start();
  while (!server_->serving()) std::this_thread::sleep_for(1ms);
}

TestServer::~TestServer() {
  server_.reset();
  running_ = false;
  node_.join();
}

std::vector<Command> TestServer::taken() {
  const std::lock_guard lock(mutex_);
  return taken_;
}

std::vector<std::string> TestServer::injected() {
  const std::lock_guard lock(mutex_);
  return injected_;
}

}  // namespace rover::mission::test
