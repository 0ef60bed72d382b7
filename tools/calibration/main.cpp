// ./rover calibration FILE...: makes cameras.yaml from calibration files of OpenCV, Kalibr or ROS.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "common/bus/command_line.hpp"
#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/frames.hpp"
#include "tools/calibration/cameras_yaml.hpp"
#include "tools/calibration/read.hpp"

namespace {

using namespace rover;
using namespace rover::calibration;

struct Arguments {
  std::vector<std::string> files;
  std::string config_dir = project_dir() + "/config";
  std::string camera = "loccam";
  std::string model;
  std::vector<int> size;
  std::vector<double> mount;    // x y z [m], pitch down, roll, yaw [deg]
  std::vector<double> imu_rpy;  // IMU in body [deg]
  std::string out;
};

// Camera mount: from the command line, from the calibrated IMU, or from the existing file.
Mount mount_for(const Arguments& arguments, const StereoCalibration& calibration) {
  if (!arguments.mount.empty()) {
    const std::vector<double>& m = arguments.mount;
    return {{m[0], m[1], m[2]}, to_rad(m[3]), to_rad(m[4]), to_rad(m[5])};
  }
  if (arguments.imu_rpy.empty()) return mount_of(load_stereo_rig(arguments.config_dir, arguments.camera).T_body_left);
  if (!calibration.T_left_imu)
    throw ConfigError(arguments.files.front() + ": no T_cam_imu; --imu-rpy needs a calibration of camera and IMU");
  const Vehicle vehicle = load_vehicle(arguments.config_dir);
  const std::vector<double>& r = arguments.imu_rpy;
  const Eigen::Isometry3d T_body_imu =
      make_pose(rotation_from_rpy(to_rad(r[0]), to_rad(r[1]), to_rad(r[2])), vehicle.imu_position_m);
  return mount_of(T_body_imu * calibration.T_left_imu->inverse());
}

void set_size(const Arguments& arguments, StereoCalibration& calibration) {
  if (!arguments.size.empty()) {
    calibration.width = arguments.size[0];
    calibration.height = arguments.size[1];
  }
  if (calibration.width <= 0 || calibration.height <= 0)
    throw ConfigError(arguments.files.front() + ": contains no image size; set it with --size WIDTH HEIGHT");
}

void write_text(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw ConfigError(file + ": cannot be written");
}

void write_new(const std::string& file, const std::string& text) {
  NewFile out(file);
  write_text(out.path(), text);
  out.keep();
}

// Parse the output with the services' reader before writing it.
void check_text(const std::string& text, const std::string& camera) {
  try {
    read_stereo_rig(Config::parse(text, "cameras.yaml"), camera);
  } catch (const ConfigError& error) {
    throw ConfigError(std::string("calibration: the result is out of range: ") + error.what());
  }
}

void convert(const Arguments& arguments) {
  StereoCalibration calibration = read_calibration(arguments.files, arguments.model);
  set_size(arguments, calibration);
  std::string source = "from";
  for (const std::string& file : arguments.files) source += " " + std::filesystem::path(file).filename().string();
  const std::string text = cameras_yaml(arguments.config_dir + "/cameras.yaml", arguments.camera, calibration,
                                        mount_for(arguments, calibration), source);
  check_text(text, arguments.camera);
  if (arguments.out.empty())
    std::printf("%s", text.c_str());
  else
    write_new(arguments.out, text);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "./rover calibration FILE...: cameras.yaml from a calibration of OpenCV's (intrinsics and extrinsics), "
      "Kalibr's (camchain) or ROS's (camera_info, left and right)\nExample: ./rover calibration camchain-imucam.yaml "
      "--imu-rpy 0 0 0 --config my_config --out new.yaml");
  app.name("./rover calibration");
  app.add_option("files", arguments.files, "calibration files; for camera_info the left camera first")
      ->required()
      ->transform(is_user_path());
  app.add_option("--camera", arguments.camera, "section to write")
      ->check(CLI::IsMember({"loccam", "navcam"}))
      ->capture_default_str();
  app.add_option("--model", arguments.model, "lens model, if OpenCV's files do not specify it")
      ->check(CLI::IsMember({"radtan", "equidistant"}));
  app.add_option("--config", arguments.config_dir, "configuration folder with the other cameras and mounts")
      ->transform(is_user_path())
      ->capture_default_str();
  repeatable(app.add_option("--size", arguments.size, "image width and height [px], if not in the file"))->expected(2);
  CLI::Option* mount =
      repeatable(app.add_option(
                     "--mount", arguments.mount,
                     "left camera in body: x y z [m], pitch down, roll, yaw [deg]; default: as in the configuration"))
          ->expected(6);
  repeatable(
      app.add_option(
          "--imu-rpy", arguments.imu_rpy,
          "mount from the calibrated IMU: roll, pitch, yaw of the IMU in body [deg]; its position is in vehicle.yaml"))
      ->expected(3)
      ->excludes(mount);
  app.add_option("--out", arguments.out, "output file; default: standard output")->transform(is_user_path());
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_parse(app, error);
  }
  try {
    convert(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
