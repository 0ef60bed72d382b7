#include "rover_simulator/vehicle/vehicle_sim.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "common/core/check.hpp"
#include "rover_simulator/vehicle/belly.hpp"
#include "rover_simulator/vehicle/mjcf.hpp"

namespace rover {
namespace {

struct ModelDeleter {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
};
struct DataDeleter {
  void operator()(mjData* d) const { mj_deleteData(d); }
};

std::unique_ptr<mjModel, ModelDeleter> load_model(const std::string& mjcf) {
  const auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  ROVER_CHECK(mj_makeEmptyFileVFS(vfs.get(), "rover.xml", static_cast<int>(mjcf.size())) == 0, mjcf.size());
  std::memcpy(vfs->filedata[0], mjcf.data(), mjcf.size());
  char error[500] = "";
  std::unique_ptr<mjModel, ModelDeleter> model(mj_loadXML("rover.xml", vfs.get(), error, sizeof error));
  mj_deleteVFS(vfs.get());
  ROVER_CHECK(model != nullptr, error);
  return model;
}

using Vec3Map = Eigen::Map<const Eigen::Vector3d>;

// Locks a joint. MuJoCo integrates damping implicitly, so this value is stable at the step size.
constexpr double kJammedNms = 1e5;

constexpr int kSettleAttempts = 24;
constexpr double kSettledM = 0.005;
constexpr double kSettledRad = to_rad(0.03);

}  // namespace

class VehicleSim::Impl {
 public:
  Impl(const Vehicle& vehicle, const VehicleSimConfig& config, const Surface& surface, const Pose2& start)
      : vehicle_(vehicle),
        config_(config),
        heights_(surface),
        model_(load_model(make_mjcf(vehicle, config))),
        data_(mj_makeData(model_.get())) {
    for (int i = 0; i < 6; ++i) wheel_[i] = find(mjOBJ_BODY, "wheel", i);
    for (int i = 0; i < 6; ++i) drive_[i] = find(mjOBJ_JOINT, "drive", i);
    for (int i = 0; i < 4; ++i) steer_[i] = find(mjOBJ_JOINT, "steer", i);
    for (int i = 0; i < 3; ++i) bogie_[i] = find(mjOBJ_JOINT, "bogie", i);
    settle_at(start);
  }

  void advance(double dt_s, const WheelCommand& command) {
    const int steps = static_cast<int>(std::lround(dt_s / config_.step_s));
    ROVER_CHECK(steps > 0 && std::abs(steps * config_.step_s - dt_s) < 1e-9, dt_s, config_.step_s);
    const Eigen::Matrix3d R_before = R_level_ground_felt_ * pose().linear();
    begin_interval();
    for (int i = 0; i < steps; ++i) step(command);
    truth_.interval_s = dt_s;
    R_level_ground_felt_ = R_level_ground_;
    truth_.delta_angle_rad = log_so3(R_before.transpose() * (R_level_ground_felt_ * pose().linear()));
    truth_.specific_force_body_mps2 = truth_.delta_velocity_mps / dt_s;
    end_interval();
  }

  void set_faults(const VehicleFaults& faults) {
    loose_sand_ = faults.loose_sand;
    R_level_ground_ = faults.R_level_ground;
    Eigen::Map<Eigen::Vector3d>{model_->opt.gravity} =
        R_level_ground_.transpose() * Eigen::Vector3d(0.0, 0.0, -config_.gravity_mps2);
    for (int i = 0; i < 6; ++i)
      model_->dof_damping[model_->jnt_dofadr[drive_[i]]] = faults.jammed[i] ? kJammedNms : 0.0;
  }

  const VehicleTruth& truth() const { return truth_; }

 private:
  int find(int type, const char* name, int index) const {
    const int id = mj_name2id(model_.get(), type, (name + std::to_string(index)).c_str());
    ROVER_CHECK(id >= 0, name, index);
    return id;
  }
  double angle(int joint) const { return data_->qpos[model_->jnt_qposadr[joint]]; }
  double rate(int joint) const { return data_->qvel[model_->jnt_dofadr[joint]]; }
  void apply(int joint, double torque_nm) { data_->qfrc_applied[model_->jnt_dofadr[joint]] = torque_nm; }

  // The free joint comes first: position, quaternion wxyz; linear velocity in map axes, rates in body axes.
  Eigen::Isometry3d pose() const {
    const mjtNum* q = data_->qpos;
    return make_pose(Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix(), Vec3Map(q));
  }
  Eigen::Vector3d imu_velocity() const {
    const Eigen::Vector3d rates = Vec3Map(data_->qvel + 3);
    return Vec3Map(data_->qvel) + pose().linear() * rates.cross(vehicle_.imu_position_m);
  }

  // Settling moves the vehicle, by up to a degree on rough ground; the initial pose compensates for it. On side slopes
  // the whole error at once may be too much.
  void settle_at(const Pose2& start) {
    Pose2 aim = start;
    double part = 1.0, before = kInfinity;
    for (int attempt = 0; attempt < kSettleAttempts; ++attempt) {
      put_at_rest(aim);
      const Pose2 rest = planar(truth_.T_map_body);
      const Pose2 off{rest.x_m - start.x_m, rest.y_m - start.y_m, wrap_angle(rest.yaw_rad - start.yaw_rad)};
      const double error = std::max(std::hypot(off.x_m, off.y_m) / kSettledM, std::abs(off.yaw_rad) / kSettledRad);
      if (error < 1.0) return;
      part = error < before ? std::min(1.0, 1.3 * part) : 0.5 * part;
      before = error;
      aim = {aim.x_m - part * off.x_m, aim.y_m - part * off.y_m, aim.yaw_rad - part * off.yaw_rad};
    }
  }

  void put_at_rest(const Pose2& aim) {
    mj_resetData(model_.get(), data_.get());
    bristle_ = {};
    drive_motor_ = {};
    steer_motor_ = {};
    set_down(aim);
    advance(config_.settle_s, WheelCommand{});
  }

  // Initial pose on the plane fitted to the ground under the wheels, with all wheels just above it.
  void set_down(const Pose2& start) {
    Eigen::Matrix<double, 6, 3> A;
    Eigen::Matrix<double, 6, 1> z;
    for (int i = 0; i < 6; ++i) {
      const double c = std::cos(start.yaw_rad), s = std::sin(start.yaw_rad);
      const double x = vehicle_.wheel_x_m[i], y = vehicle_.wheel_y_m[i];
      A.row(i) << 1.0, x, y;  // wheel contact points, relative to the point below the body origin
      z[i] = heights_.height_m(start.x_m + c * x - s * y, start.y_m + s * x + c * y);
    }
    const Eigen::Vector3d plane = A.colPivHouseholderQr().solve(z);
    const double rise = std::max(0.0, (z - A * plane).maxCoeff());
    const Eigen::Matrix3d R = rotation_from_rpy(std::atan(plane[2]), -std::atan(plane[1]), start.yaw_rad);
    const Eigen::Quaterniond q(R);
    const Eigen::Vector3d p(start.x_m, start.y_m, plane[0] + rise + vehicle_.origin_height_m / R(2, 2));
    const double values[7] = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
    std::copy(std::begin(values), std::end(values), data_->qpos);
  }

  void begin_interval() {
    truth_.delta_velocity_mps.setZero();
    truth_.clearance_m = belly_clearance_m(vehicle_, heights_, pose());
    truth_.climb_m = 0.0;
    along_mps_.fill(0.0);
    rim_mps_.fill(0.0);
  }

  void step(const WheelCommand& command) {
    const Eigen::Vector3d velocity_before = imu_velocity();
    mj_step1(model_.get(), data_.get());
    for (int i = 0; i < 6; ++i) push_wheel(i);
    run_motors(command);
    mj_step2(model_.get(), data_.get());
    const Eigen::Vector3d gained = imu_velocity() - velocity_before - Vec3Map(model_->opt.gravity) * config_.step_s;
    truth_.delta_velocity_mps += pose().linear().transpose() * gained;
  }

  void run_motors(const WheelCommand& command) {
    for (int i = 0; i < 6; ++i) {
      const MotorOutput out =
          drive_motor_[i].step(config_.drive, vehicle_.drive_current_limit_a, command.drive_rate_radps[i],
                               angle(drive_[i]), rate(drive_[i]), config_.step_s);
      apply(drive_[i], out.torque_nm);
      truth_.drive_current_a[i] = out.current_a;
    }
    for (int i = 0; i < 4; ++i) {
      const double wanted = std::clamp(command.steer_angle_rad[i], -vehicle_.steer_max_rad, vehicle_.steer_max_rad);
      const MotorOutput out =
          steer_motor_[i].step(config_.steer, vehicle_.steer_current_limit_a, vehicle_.steer_rate_radps, wanted,
                               angle(steer_[i]), rate(steer_[i]), config_.step_s);
      apply(steer_[i], out.torque_nm);
      truth_.steer_current_a[i] = out.current_a;
    }
  }

  Eigen::Isometry3d wheel_pose(int i) const {
    return make_pose(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * wheel_[i]),
                     Vec3Map(data_->xpos + 3 * wheel_[i]));
  }

  void push_wheel(int i) {
    const int body = wheel_[i];
    const Eigen::Isometry3d T_map_wheel = wheel_pose(i);
    const Eigen::Vector3d axle = T_map_wheel.translation();
    const Eigen::Matrix3d R_map_wheel = T_map_wheel.linear();
    WheelContact contact = find_contact(config_.contact, vehicle_, heights_, axle, R_map_wheel);
    if (loose_sand_) contact.soil_fraction = {1.0, 0.0, 0.0};
    double* wrench = data_->xfrc_applied + 6 * body;
    std::fill(wrench, wrench + 6, 0.0);
    note_contact(i, contact);
    const double spin = rate(drive_[i]), rim_mps = spin * vehicle_.wheel_radius_m;
    rim_mps_[i] += rim_mps;
    if (contact.load_n <= 0.0) {
      bristle_[i].release();
      along_mps_[i] += rim_mps;
      return;
    }
    const Eigen::Vector3d across = R_map_wheel.col(1), along = across.cross(contact.normal);
    double motion[6];  // rotation, translation, at the axle in map axes
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, body, motion, 0);
    const Eigen::Vector3d hub_rate = Vec3Map(motion) - spin * across, arm = contact.point - axle;
    const Eigen::Vector3d velocity = Vec3Map(motion + 3) + hub_rate.cross(arm);
    along_mps_[i] += velocity.dot(along);

    const double load = contact.load_n * damping_factor(velocity.dot(contact.normal));
    const Eigen::Vector2d traction = bristle_[i].step(config_.soil, contact.soil_fraction, load, velocity.dot(along),
                                                      velocity.dot(across), rim_mps, config_.step_s);
    truth_.wheel_load_n[i] = load;
    const Eigen::Vector3d rim_force = load * contact.normal + traction.x() * along + traction.y() * across;
    const Eigen::Vector3d axle_force =
        rolling_force(config_.soil, contact.soil_fraction, load, velocity.dot(along)) * along;
    const double scrub = scrub_torque(config_.soil, contact.soil_fraction, load, hub_rate.dot(contact.normal));
    Eigen::Map<Eigen::Vector3d>{wrench} = rim_force + axle_force;
    Eigen::Map<Eigen::Vector3d>{wrench + 3} = arm.cross(rim_force) + scrub * contact.normal;
  }

  double damping_factor(double departing_mps) const {
    return std::clamp(1.0 - config_.contact.damping_spm * departing_mps, 0.0, 3.0);
  }
  void note_contact(int i, const WheelContact& contact) {
    truth_.wheel_load_n[i] = contact.load_n;
    truth_.wheel_sinkage_m[i] = contact.sinkage_m;
    truth_.climb_m = std::max(truth_.climb_m, contact.climb_m);
    if (contact.load_n <= 0.0) return;
    const auto most = std::max_element(contact.soil_fraction.begin(), contact.soil_fraction.end());
    truth_.wheel_soil[i] = static_cast<Soil>(most - contact.soil_fraction.begin());
  }

  void note_edges() {
    for (int i = 0; i < 6; ++i) {
      const Eigen::Isometry3d at = wheel_pose(i);
      const double climb_m = climb_at_edges_m(config_.contact, vehicle_, heights_, at.translation(), at.linear());
      truth_.climb_m = std::max(truth_.climb_m, climb_m);
    }
  }

  // A beam or a fork touches ground or rock.
  bool suspension_touches() {
    for (int i = 0; i < model_->nsite; ++i) {
      const mjtNum* p = data_->site_xpos + 3 * i;
      if (p[2] <= heights_.height_m(p[0], p[1])) return true;
    }
    return false;
  }

  void end_interval() {
    truth_.T_map_body = pose();
    truth_.velocity_map_mps = Vec3Map(data_->qvel);
    truth_.rate_body_radps = Vec3Map(data_->qvel + 3);
    for (int i = 0; i < 6; ++i) {
      truth_.wheel_angle_rad[i] = angle(drive_[i]);
      truth_.wheel_rate_radps[i] = rate(drive_[i]);
      const double steps = truth_.interval_s / config_.step_s;
      constexpr double kTurningMps = 0.005;
      const bool turning = std::abs(rim_mps_[i]) / steps > kTurningMps;
      truth_.wheel_slip[i] = turning ? 1.0 - along_mps_[i] / rim_mps_[i] : 0.0;
    }
    for (int i = 0; i < 4; ++i) truth_.steer_angle_rad[i] = angle(steer_[i]);
    for (int i = 0; i < 3; ++i) truth_.bogie_angle_rad[i] = angle(bogie_[i]);
    truth_.clearance_m = std::min(truth_.clearance_m, belly_clearance_m(vehicle_, heights_, truth_.T_map_body));
    note_edges();
    truth_.collision = Collision::kNone;
    if (truth_.climb_m > vehicle_.max_climb_m) truth_.collision = Collision::kWheelClimb;
    if (truth_.clearance_m <= 0.0 || suspension_touches()) truth_.collision = Collision::kBodyContact;
  }

  Vehicle vehicle_;
  VehicleSimConfig config_;
  HeightCache heights_;
  std::unique_ptr<mjModel, ModelDeleter> model_;
  std::unique_ptr<mjData, DataDeleter> data_;
  std::array<int, 6> wheel_{}, drive_{};
  std::array<int, 4> steer_{};
  std::array<int, 3> bogie_{};
  std::array<Bristle, 6> bristle_;
  std::array<DriveMotor, 6> drive_motor_;
  std::array<SteerMotor, 4> steer_motor_;
  std::array<double, 6> along_mps_{}, rim_mps_{};  // sums over the interval
  bool loose_sand_ = false;
  Eigen::Matrix3d R_level_ground_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_level_ground_felt_ = Eigen::Matrix3d::Identity();  // at the end of the last advance()
  VehicleTruth truth_;
};

VehicleSim::VehicleSim(const Vehicle& vehicle, const VehicleSimConfig& config, const Surface& surface,
                       const Pose2& start)
    : impl_(std::make_unique<Impl>(vehicle, config, surface, start)) {}
VehicleSim::~VehicleSim() = default;
void VehicleSim::advance(double dt_s, const WheelCommand& command) {
  impl_->advance(dt_s, command);
}
void VehicleSim::set_faults(const VehicleFaults& faults) {
  impl_->set_faults(faults);
}
const VehicleTruth& VehicleSim::truth() const {
  return impl_->truth();
}

}  // namespace rover
