// hazard_calibrate LOG: calibrates the hazard detector's camera from DISPARITY messages recorded on flat ground.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <lcm/lcm-cpp.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/command_line.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/frames.hpp"
#include "hazard_detector/config.hpp"
#include "hazard_detector/convert.hpp"
#include "tools/hazard_calibrate/calibrate.hpp"

namespace rover::hazard {
namespace {

struct Arguments {
  std::string log;
  std::string config_dir = rover::project_dir() + "/config";
  std::string out;
};

CalibrationFrames read_frames(const std::string& file) {
  if (const std::string problem = file_problem(file); !problem.empty()) throw ConfigError(file + ": " + problem);
  lcm::LogFile log(file, "r");
  if (!log.good()) throw ConfigError(file + ": cannot be read");
  CalibrationFrames frames{CalibrateConfig{}};
  int skipped = 0;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    if (event->channel != channel::kDisparity) continue;
    disparity_t message{};
    if (decode_message(event->data, event->datalen, message) && validation_error(message).empty())
      frames.add(disparity_from(message), camera_from(message));
    else
      ++skipped;
  }
  if (frames.frames() == 0) throw ConfigError(file + ": no log, or one without usable DISPARITY");
  if (skipped > 0) std::cerr << file << ": " << skipped << " unusable DISPARITY messages skipped\n";
  return frames;
}

void write(const std::string& file, const CalibrationFit& fit, int frames) {
  std::ofstream out(file);
  out << fmt::format(
      "# Written by hazard_calibrate: the rectified left LocCam over flat ground.\n"
      "# {} frames, {} pixels, {:.1f} % inliers, {:.3f} px rms.\n"
      "height_m: {:.5f}\npitch_deg: {:.4f}\nroll_deg: {:.4f}\n",
      frames, fit.pixels, 100.0 * fit.inlier_fraction, fit.rms_px, fit.calibration.height_m,
      to_deg(fit.calibration.pitch_rad), to_deg(fit.calibration.roll_rad));
  if (!out.flush()) throw ConfigError(file + ": cannot be written");
}

int run(const Arguments& arguments) {
  const CalibrationFrames frames = read_frames(arguments.log);
  const CalibrationFit fit = frames.fit(load_vehicle(arguments.config_dir).origin_height_m);
  if (!fit.ok) {
    std::cerr << arguments.log << ": " << fit.failure << "\n";
    return 1;
  }
  const std::string file = arguments.out.empty() ? arguments.config_dir + "/" + kCalibrationFile : arguments.out;
  write(file, fit, frames.frames());
  std::cout << fmt::format("{}: height {:.4f} m, pitch {:.3f} deg, roll {:.3f} deg, rms {:.3f} px\n", file,
                           fit.calibration.height_m, to_deg(fit.calibration.pitch_rad),
                           to_deg(fit.calibration.roll_rad), fit.rms_px);
  return 0;
}

}  // namespace
}  // namespace rover::hazard

int main(int argc, char** argv) {
  rover::hazard::Arguments arguments;
  CLI::App app("Makes the hazard detector's calibration from a log of flat ground");
  app.add_option("log", arguments.log, "LCM log with DISPARITY messages")->required();
  app.add_option("--config", arguments.config_dir, "folder with vehicle.yaml");
  app.add_option("--out", arguments.out, "file to write; default: the one in the config folder that is read at start");
  try {
    rover::parse_arguments(app, argc, argv);
    return rover::hazard::run(arguments);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  } catch (const rover::ConfigError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
