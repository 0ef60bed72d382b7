// Tool, not a test: make_euroc_data_set DIR PAIRS [equidistant] writes a drive over rendered ground in EuRoC layout,
// with distorted images.
//
// The sensor frame is rotated and translated relative to the body, as in the real data sets.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "../rover_simulator/camera_test_world.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kFirstNs = 1'403'636'579'763'555'584;
constexpr std::int64_t kPeriodNs = 100'000'000;
constexpr double kStepM = 0.12;  // 1.2 m/s: six times the rover's top speed

// Pose of the sensors in the body.
Eigen::Isometry3d T_body_sensors() {
  return rover::make_pose(rover::rotation_from_rpy(0.3, -1.2, 2.0), {0.1, -0.05, 0.2});
}

// The smooth part of the surface, without rocks.
double ride_height_m(double x, double y) {
  return 0.25 * std::sin(0.2 * x) * std::cos(0.23 * y) + 0.68;
}

void write_sensor(const fs::path& file, const rover::StereoRig& rig, const rover::PinholeCamera& camera,
                  const Eigen::Isometry3d& T_sensors_camera) {
  std::ofstream out(file);
  out.precision(15);
  out << "# General sensor definitions.\nsensor_type: camera\ncomment: rendered\n\nT_BS:\n  cols: 4\n  rows: 4\n  "
         "data: [";
  for (int i = 0; i < 16; ++i) out << (i > 0 ? ", " : "") << T_sensors_camera.matrix()(i / 4, i % 4);
  out << "]\n\nrate_hz: 10\nresolution: [" << rig.width << ", " << rig.height
      << "]\ncamera_model: pinhole\nintrinsics: [" << camera.fx_px << ", " << camera.fy_px << ", " << camera.cx_px
      << ", " << camera.cy_px << "] #fu, fv, cu, cv\ndistortion_model: "
      << (camera.model == rover::DistortionModel::kRadTan ? "radial-tangential" : "equidistant")
      << "\ndistortion_coefficients: [" << camera.distortion[0] << ", " << camera.distortion[1] << ", "
      << camera.distortion[2] << ", " << camera.distortion[3] << "]\n";
}

// 100 deg from corner to corner.
rover::StereoRig with_fisheyes(rover::StereoRig rig) {
  for (rover::PinholeCamera* camera : {&rig.left, &rig.right}) {
    camera->model = rover::DistortionModel::kEquidistant;
    camera->distortion = {-0.012, 0.018, -0.009, 0.0015, 0.0};
    camera->fx_px = camera->fy_px = 370.0;
  }
  return rig;
}

void write_picture(const fs::path& file, const rover::GrayImage& image) {
  const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data.data()));
  if (!cv::imwrite(file.string(), view)) std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "make_euroc_data_set DIR PAIRS [equidistant]\n");
    return 2;
  }
  const fs::path root = fs::path(argv[1]) / "mav0";
  const int pairs = std::atoi(argv[2]);
  const rover::test::RockySurface surface(0.0);
  rover::CameraSimConfig config;
  config.calibration_error_px = 0.0;
  config.scene = rover::test::small_scene();
  rover::StereoCameraSim camera(argc > 3 ? with_fisheyes(rover::test::loccam_rig()) : rover::test::loccam_rig(), config,
                                surface, 1);
  const rover::StereoRig rig = camera.true_rig();
  for (const char* dir : {"cam0/data", "cam1/data", "state_groundtruth_estimate0"}) fs::create_directories(root / dir);
  const Eigen::Isometry3d T_sensors_left = T_body_sensors().inverse() * rig.T_body_left;
  write_sensor(root / "cam0/sensor.yaml", rig, rig.left, T_sensors_left);
  write_sensor(root / "cam1/sensor.yaml", rig, rig.right, T_sensors_left * rig.T_left_right);
  std::ofstream lists[2] = {std::ofstream(root / "cam0/data.csv"), std::ofstream(root / "cam1/data.csv")};
  for (std::ofstream& list : lists) list << "#timestamp [ns],filename\r\n";
  std::ofstream truth(root / "state_groundtruth_estimate0/data.csv");
  truth.precision(15);
  truth << "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\r\n";

  double x = 0.0, y = 0.0;
  for (int i = 0; i < pairs; ++i) {
    const double yaw = 0.3 * std::sin(0.05 * i);
    const Eigen::Isometry3d T_map_body =
        rover::make_pose(rover::rotation_from_rpy(0.0, 0.0, yaw), {x, y, ride_height_m(x, y)});
    const rover::StereoCameraSim::Pair pair = camera.render(T_map_body, i);
    const std::int64_t time_ns = kFirstNs + i * kPeriodNs;
    const std::string name = std::to_string(time_ns) + ".png";
    write_picture(root / "cam0/data" / name, pair.left);
    write_picture(root / "cam1/data" / name, pair.right);
    for (std::ofstream& list : lists) list << time_ns << "," << name << "\r\n";
    const Eigen::Isometry3d T = T_map_body * T_body_sensors();
    const Eigen::Quaterniond q(T.linear());
    truth << time_ns << "," << T.translation().x() << "," << T.translation().y() << "," << T.translation().z() << ","
          << q.w() << "," << q.x() << "," << q.y() << "," << q.z() << ",0,0,0\r\n";
    x += kStepM * std::cos(yaw);
    y += kStepM * std::sin(yaw);
  }
  return 0;
}
