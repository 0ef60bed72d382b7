// rover_import DATA_SET: converts a stereo data set to the log of a run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "common/bus/command_line.hpp"
#include "common/bus/interrupt.hpp"
#include "tools/interchange/import_data_set.hpp"

int main(int argc, char** argv) {
  rover::interchange::ImportOptions options;
  options.config_dir = rover::project_dir() + "/config";
  CLI::App app(
      "./rover import: a stereo data set in KITTI's or EuRoC's layout as the log of a run. Example:\n"
      "./rover import kitti/sequences/06 --out logs/kitti06");
  app.name("./rover import");
  app.add_option("data_set", options.data_set, "folder of the data set")->required()->transform(rover::is_user_path());
  app.add_option("--out", options.out, "new run folder; default: logs/<name of the data set>")
      ->transform(rover::is_user_path());
  app.add_option("--poses", options.poses,
                 "KITTI: ground truth; default: poses.txt in the folder, or poses/NN.txt of the data set")
      ->transform(rover::is_user_path());
  app.add_option("--rate", options.rate_hz, "KITTI without times.txt: pairs per second")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  app.add_option("--max-disparity", options.max_disparity_px, "maximum disparity [px], a multiple of 16")
      ->capture_default_str();
  app.add_option("--max-speed", options.max_speed_mps, "maximum plausible speed [m/s]")
      ->check(CLI::Range(0.1, 200.0))
      ->capture_default_str();
  app.add_option("--config", options.config_dir, "configuration to adapt")
      ->transform(rover::is_user_path())
      ->capture_default_str();
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  if (options.out.empty())
    options.out = rover::project_dir() + "/logs/" + std::filesystem::path(options.data_set).filename().string();
  rover::catch_interrupts();
  try {
    for (const std::string& line : rover::interchange::import_data_set(options)) std::printf("%s\n", line.c_str());
  } catch (const rover::interchange::Interrupted& end) {
    std::fprintf(stderr, "%s\n", end.what());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
