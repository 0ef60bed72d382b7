#include <filesystem>

#include "common/bus/node_main.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/service_names.hpp"
#include "common/bus/vehicle_config.hpp"
#include "mission_control/node.hpp"
#include "mission_control/page_server.hpp"

namespace {

using namespace rover;
using namespace rover::mission;

PageContext page_context(const NodeContext& context) {
  const std::string run_dir = context.node.options().run_dir;
  const Vehicle vehicle = load_vehicle(context.config_dir);
  PageContext page;
  page.run_dir = run_dir;
  page.run_name = run_dir.empty() ? "manual" : std::filesystem::path(run_dir).filename().string();
  page.allow_injection = context.node.options().allow_injection;
  for (const std::string& name : service_names(true))
    if (run_dir.empty() || keeps_service(run_dir, name)) page.services.push_back(name);
  page.rover_length_m = 2.0 * vehicle.footprint_half_length_m();
  page.setup = page_setup(context.config_dir, vehicle);
  page.inject = [run_dir](const std::string& service, CommandKind kind) {
    return control_service(run_dir, service, kind == CommandKind::kHang ? "-p" : "-k");
  };
  return page;
}

struct MissionControl {
  std::shared_ptr<SharedState> shared = std::make_shared<SharedState>();
  std::unique_ptr<PageServer> page;
  MissionControlNode node;

  MissionControl(const NodeContext& context, const PageConfig& config)
      : page(config.served
                 ? std::make_unique<PageServer>(config, page_context(context), *shared, context.node.share_bus())
                 : nullptr),
        node(context.node, load_mission_plan(context.config_dir), shared, config.path, [this] {
          if (page) page->update();
        }) {
    if (page) page->start();
  }
};

}  // namespace

int main(int argc, char** argv) {
  return node_main(argc, argv, "mission_control", mission::load_config, [](const NodeContext& context) {
    return std::make_shared<MissionControl>(context, load_config(context.config_dir));
  });
}
