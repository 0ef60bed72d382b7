#include "common/bus/vehicle_config.hpp"

#include <algorithm>
#include <sstream>

#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr Range kMetres{0.0, 10.0};
constexpr Range kSignedMetres{-10.0, 10.0};
constexpr double kLeastBaselineM = 0.005;
constexpr double kMaxBaselineM = 5.0;

template <size_t N>
std::array<double, N> fixed(const Config& config, const std::string& key, Range range) {
  const std::vector<double> values = config.numbers(key, range, N);
  std::array<double, N> out{};
  std::copy(values.begin(), values.end(), out.begin());
  return out;
}

Eigen::Vector3d vector3(const Config& config, const std::string& key, Range range) {
  const auto values = fixed<3>(config, key, range);
  return {values[0], values[1], values[2]};
}

PinholeCamera pinhole(const Config& config, DistortionModel model) {
  PinholeCamera camera;
  camera.model = model;
  camera.fx_px = config.number("fx_px", {10, 1e5});
  camera.fy_px = config.number("fy_px", {10, 1e5});
  camera.cx_px = config.number("cx_px", {0, 1e5});
  camera.cy_px = config.number("cy_px", {0, 1e5});
  const Range range{-10, 10};
  if (model == DistortionModel::kRadTan)
    camera.distortion = fixed<5>(config, "distortion", range);
  else
    std::ranges::copy(fixed<4>(config, "distortion", range), camera.distortion.begin());
  return camera;
}

void read_body(const Config& body, Vehicle& v) {
  v.origin_height_m = body.number("origin_height_m", kMetres);
  v.body_mass_kg = body.number("mass_kg", {1, 1e4});
  v.body_half_length_m = body.number("half_length_m", kMetres);
  v.body_half_width_m = body.number("half_width_m", kMetres);
  v.body_top_m = body.number("top_m", kMetres);
  v.belly_clearance_m = body.number("belly_clearance_m", kMetres);
}

void read_wheels(const Config& wheels, Vehicle& v) {
  v.wheel_radius_m = wheels.number("radius_m", {0.01, 2});
  v.wheel_width_m = wheels.number("width_m", {0.01, 2});
  v.wheel_mass_kg = wheels.number("mass_kg", {0.01, 1000});
  v.wheel_x_m = fixed<6>(wheels, "x_m", kSignedMetres);
  v.wheel_y_m = fixed<6>(wheels, "y_m", kSignedMetres);
}

void read_motors(const Config& steering, const Config& drive, Vehicle& v) {
  v.steer_max_rad = to_rad(steering.number("max_angle_deg", {0, 180}));
  v.steer_rate_radps = to_rad(steering.number("max_rate_degps", {0.1, 720}));
  v.steer_current_nominal_a = steering.number("current_nominal_a", {0, 1000});
  v.steer_current_limit_a = steering.number("current_limit_a", {0, 1000});
  v.gear_ratio = drive.number("gear_ratio", {1, 1e5});
  v.drive_current_nominal_a = drive.number("current_nominal_a", {0, 1000});
  v.drive_current_limit_a = drive.number("current_limit_a", {0, 1000});
}

void read_limits(const Config& limits, Vehicle& v) {
  v.top_speed_mps = limits.number("top_speed_mps", {0.01, 10});
  v.deceleration_mps2 = limits.number("deceleration_mps2", {0.01, 10});
  v.min_turn_radius_m = limits.number("min_turn_radius_m", kMetres);
  v.max_climb_m = limits.number("max_climb_m", kMetres);
  v.hazard_height_m = limits.number("hazard_height_m", kMetres);
}

PanTiltUnit read_pan_tilt(const Config& config) {
  PanTiltUnit unit;
  unit.p_body_axes = vector3(config, "axes_position_m", kSignedMetres);
  unit.pan_max_rad = to_rad(config.number("pan_max_deg", {0, 180}));
  unit.tilt_min_rad = to_rad(config.number("tilt_min_deg", {-90, 0}));
  unit.tilt_max_rad = to_rad(config.number("tilt_max_deg", {0, 90}));
  unit.rate_radps = to_rad(config.number("rate_degps", {0.1, 720}));
  return unit;
}

}  // namespace

Vehicle load_vehicle(const std::string& config_dir) {
  const Config config = Config::load(config_dir + "/vehicle.yaml");
  Vehicle vehicle;
  read_body(config.section("body"), vehicle);
  read_wheels(config.section("wheels"), vehicle);
  read_motors(config.section("steering"), config.section("drive"), vehicle);
  read_limits(config.section("limits"), vehicle);
  if (config.has("imu")) vehicle.imu_position_m = vector3(config.section("imu"), "position_m", kSignedMetres);
  if (config.has("pan_tilt")) vehicle.pan_tilt = read_pan_tilt(config.section("pan_tilt"));
  config.finish();
  return vehicle;
}

std::string problem_of_pair(const Eigen::Isometry3d& T_left_right) {
  const Eigen::Vector3d& p = T_left_right.translation();
  if (!is_finite(T_left_right)) return "the pose of the right camera is not finite";
  const Eigen::Matrix3d& R = T_left_right.linear();
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 || R.determinant() < 0.0)
    return "the rotation between the cameras is no rotation";
  if (p.norm() < kLeastBaselineM || p.norm() > kMaxBaselineM) {
    std::ostringstream text;
    text << "a baseline of " << p.norm() << " m; " << kLeastBaselineM << " to " << kMaxBaselineM
         << " m are expected (is it in millimetres, or the size of the board's squares?)";
    return text.str();
  }
  if (p.x() < 0.5 * p.norm()) return "the second camera is not to the right of the first one; exchange left and right";
  return {};
}

const char* name_of(DistortionModel model) {
  return model == DistortionModel::kRadTan ? "radtan" : "equidistant";
}

StereoRig load_stereo_rig(const std::string& config_dir, const std::string& camera) {
  return read_stereo_rig(Config::load(config_dir + "/cameras.yaml"), camera);
}

StereoRig read_stereo_rig(const Config& config, const std::string& camera) {
  const Config rig_config = config.section(camera);
  StereoRig rig;
  rig.width = rig_config.integer("width_px", {16, 8192});
  rig.height = rig_config.integer("height_px", {16, 8192});
  auto model = DistortionModel::kRadTan;
  const std::vector<std::string> models = {name_of(model), name_of(DistortionModel::kEquidistant)};
  if (rig_config.has("distortion_model") && rig_config.one_of("distortion_model", models) == models[1])
    model = DistortionModel::kEquidistant;
  rig.left = pinhole(rig_config.section("left"), model);
  rig.right = pinhole(rig_config.section("right"), model);
  const Config right = rig_config.section("right_in_left");
  const Eigen::Vector3d rpy = vector3(right, "rpy_deg", {-180, 180}) * (kPi / 180.0);
  rig.T_left_right =
      make_pose(rotation_from_rpy(rpy.x(), rpy.y(), rpy.z()), vector3(right, "position_m", kSignedMetres));
  const std::string problem = problem_of_pair(rig.T_left_right);
  if (!problem.empty()) rig_config.fail("right_in_left", problem);
  const Config mount = rig_config.section("left_in_body");
  rig.T_body_left = make_pose(
      camera_rotation(to_rad(mount.number("pitch_down_deg", {-90, 90})), to_rad(mount.number("roll_deg", {-180, 180})),
                      to_rad(mount.number("yaw_deg", {-180, 180}))),
      vector3(mount, "position_m", kSignedMetres));
  rig_config.finish();
  return rig;
}

}  // namespace rover
