// made_up_page PORT: the page of a made-up drive at the Full level, until it is interrupted. For looks and for
// full_page_test.py.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "common/bus/service_names.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "mission_control/page_server.hpp"
#include "test/common/temp_folder.hpp"
#include "test/mission_control/made_up_drive.hpp"

namespace {

using namespace rover;
using namespace rover::mission;

std::sig_atomic_t ended = 0;

PageContext page_context(const std::string& run_dir) {
  const std::string config_dir = ROVER_SOURCE_DIR "/config";
  const Vehicle vehicle = load_vehicle(config_dir);
  PageContext page;
  page.run_dir = run_dir;
  page.run_name = "made up";
  page.services = service_names(true);
  page.rover_length_m = 2.0 * vehicle.footprint_half_length_m();
  page.setup = page_setup(config_dir, vehicle);
  page.inject = [](const std::string&, CommandKind) { return false; };
  return page;
}

GlobalPath whole_path() {
  GlobalPath path;
  for (double s = 0.0; s <= 45.0; s += 1.0) {
    const Pose2 at = test::MadeUpDrive::pose_at(s);
    path.x_m.push_back(at.x_m);
    path.y_m.push_back(at.y_m);
    path.level.push_back(1);
  }
  path.corridor_half_width_m = 1.5;
  return path;
}

void fill(SharedState& shared) {
  shared.book.with([](Logbook& book) {
    book.set_path(1, whole_path());
    for (double s = 0.0; s <= 12.0; s += 0.1) {
      const Pose2 at = test::MadeUpDrive::pose_at(s);
      book.add_track_point(at.x_m, at.y_m);
    }
    book.add_event(0.0, Tone::kInfo, "level", "level FULL: slow_progress effective_speed_mps 0.043 limit 0.06");
  });
}

int serve(int port) {
  const testing_support::TempFolder folder;
  lcm::LCM bus("memq://");
  test::MadeUpDrive drive(bus, service_names(true));
  write_geotiff(folder.file("orbital_map.tif"), drive.world().orbital_map(0.5));
  SharedState shared;
  fill(shared);
  PageConfig config;
  config.guard.port = port;
  PageServer page(config, page_context(folder.path()), shared, bus);
  page.start();
  auto next = std::chrono::steady_clock::now();
  for (Utime now = 0; !ended; now += kTickUs) {
    page.update();
    drive.say(now);
    while (bus.handleTimeout(0) > 0) {
    }
    std::this_thread::sleep_until(next += std::chrono::microseconds(kTickUs));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const int port = argc == 2 ? std::atoi(argv[1]) : 0;
  if (port <= 0) {
    std::cerr << "made_up_page PORT\n";
    return 2;
  }
  std::signal(SIGTERM, [](int) { ended = 1; });
  std::signal(SIGINT, [](int) { ended = 1; });
  return serve(port);
}
