#include "rover_simulator/vehicle/mjcf.hpp"

#include <cstdio>

namespace rover {
namespace {

constexpr double kHubShare = 0.25;  // of a wheel's mass that does not turn with it
constexpr double kBeamOverWheelM = 0.02;
constexpr double kBeamHalfWidthM = 0.025;
constexpr double kForkBesideWheelM = 0.04;  // the fork's far side
constexpr int kBeamSites = 16;              // along a beam

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string inertial(double mass_kg, const Eigen::Vector3d& at, const Eigen::Vector3d& diagonal) {
  return format(R"(<inertial pos="%.9g %.9g %.9g" mass="%.9g" diaginertia="%.9g %.9g %.9g"/>)", at.x(), at.y(), at.z(),
                mass_kg, diagonal.x(), diagonal.y(), diagonal.z());
}

Eigen::Vector3d box_inertia(double mass_kg, double lx, double ly, double lz) {
  return mass_kg / 12.0 * Eigen::Vector3d(ly * ly + lz * lz, lx * lx + lz * lz, lx * lx + ly * ly);
}

class Writer {
 public:
  Writer(const Vehicle& vehicle, const VehicleSimConfig& config)
      : v_(vehicle), c_(config), axle_z_m_(v_.wheel_radius_m - v_.origin_height_m) {}

  std::string model() const {
    return R"(<mujoco model="rover"><compiler angle="radian" autolimits="false"/>)" +
           format(R"(<option timestep="%.9g" gravity="0 0 %.9g"><flag contact="disable"/></option>)", c_.step_s,
                  -c_.gravity_mps2) +
           "<worldbody>" + chassis() + "</worldbody></mujoco>";
  }

 private:
  std::string chassis() const {
    const double bottom = v_.belly_clearance_m - v_.origin_height_m, height = v_.body_top_m - bottom;
    return R"(<body name="chassis"><freejoint name="chassis"/>)" +
           inertial(v_.body_mass_kg, {0.0, 0.0, bottom + 0.5 * height},
                    box_inertia(v_.body_mass_kg, 2 * v_.body_half_length_m, 2 * v_.body_half_width_m, height)) +
           side_bogie(0, 0, 2) + side_bogie(1, 1, 3) + rear_bogie() + "</body>";
  }

  std::string bogie_open(int bogie, const Eigen::Vector3d& at, const char* axis, const Eigen::Vector3d& inertia) const {
    return format(R"(<body name="bogie%d" pos="%.9g %.9g %.9g">)", bogie, at.x(), at.y(), at.z()) +
           format(R"(<joint name="bogie%d" axis="%s" damping="%.9g" limited="true" range="%.9g %.9g"/>)", bogie, axis,
                  c_.bogie_damping_nms, -c_.bogie_limit_rad, c_.bogie_limit_rad) +
           inertial(c_.bogie_mass_kg, Eigen::Vector3d::Zero(), inertia);
  }

  static std::string site(const Eigen::Vector3d& at) {
    return format(R"(<site pos="%.9g %.9g %.9g"/>)", at.x(), at.y(), at.z());
  }

  // About the pivot, `along` from end to end.
  std::string beam(const Eigen::Vector3d& along) const {
    const double z = v_.wheel_radius_m + kBeamOverWheelM - c_.bogie_pivot_height_m;
    const Eigen::Vector3d across = kBeamHalfWidthM * Eigen::Vector3d(-along.y(), along.x(), 0.0).normalized();
    std::string sites;
    for (int i = 0; i <= kBeamSites; ++i)
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d at = (static_cast<double>(i) / kBeamSites - 0.5) * along + side * across;
        sites += site({at.x(), at.y(), z});
      }
    return sites;
  }

  // It may pass what the wheel may be forced over.
  std::string fork(int wheel, const Eigen::Vector3d& axle) const {
    const double inwards = -std::copysign(0.5 * v_.wheel_width_m + kForkBesideWheelM, v_.wheel_y_m[wheel]);
    return site(axle + Eigen::Vector3d(0.0, inwards, v_.max_climb_m - v_.wheel_radius_m));
  }

  std::string side_bogie(int bogie, int front, int middle) const {
    const Eigen::Vector3d at(0.5 * (v_.wheel_x_m[front] + v_.wheel_x_m[middle]), v_.wheel_y_m[front],
                             axle_z_m_ + c_.bogie_pivot_height_m);
    const double length = v_.wheel_x_m[front] - v_.wheel_x_m[middle];
    return bogie_open(bogie, at, "0 1 0", box_inertia(c_.bogie_mass_kg, length, 0.05, 0.05)) +
           beam({length, 0.0, 0.0}) + steered(bogie, front, at) + fork(middle, wheel_position(middle) - at) +
           wheel(middle, wheel_position(middle) - at, v_.wheel_mass_kg) + "</body>";
  }

  std::string rear_bogie() const {
    const Eigen::Vector3d at(v_.wheel_x_m[4], 0.5 * (v_.wheel_y_m[4] + v_.wheel_y_m[5]),
                             axle_z_m_ + c_.bogie_pivot_height_m);
    const double width = v_.wheel_y_m[4] - v_.wheel_y_m[5];
    return bogie_open(2, at, "1 0 0", box_inertia(c_.bogie_mass_kg, 0.05, width, 0.05)) + beam({0.0, width, 0.0}) +
           steered(2, 4, at) + steered(3, 5, at) + "</body>";
  }

  std::string steered(int steer, int wheel_index, const Eigen::Vector3d& p_body_bogie) const {
    const Eigen::Vector3d at = wheel_position(wheel_index) - p_body_bogie;
    const double hub_kg = kHubShare * v_.wheel_mass_kg;
    return format(R"(<body name="hub%d" pos="%.9g %.9g %.9g">)", steer, at.x(), at.y(), at.z()) +
           format(R"(<joint name="steer%d" axis="0 0 1" armature="%.9g"/>)", steer, c_.steer.rotor_inertia_kgm2) +
           inertial(hub_kg, Eigen::Vector3d::Zero(), box_inertia(hub_kg, 0.1, 0.1, 0.1)) +
           fork(wheel_index, Eigen::Vector3d::Zero()) +
           wheel(wheel_index, Eigen::Vector3d::Zero(), v_.wheel_mass_kg - hub_kg) + "</body>";
  }

  std::string wheel(int index, const Eigen::Vector3d& at, double mass_kg) const {
    const double r2 = v_.wheel_radius_m * v_.wheel_radius_m, w2 = v_.wheel_width_m * v_.wheel_width_m;
    const double across = mass_kg * (3.0 * r2 + w2) / 12.0;
    return format(R"(<body name="wheel%d" pos="%.9g %.9g %.9g">)", index, at.x(), at.y(), at.z()) +
           format(R"(<joint name="drive%d" axis="0 1 0" armature="%.9g"/>)", index, c_.drive.rotor_inertia_kgm2) +
           inertial(mass_kg, Eigen::Vector3d::Zero(), {across, 0.5 * mass_kg * r2, across}) + "</body>";
  }

  Eigen::Vector3d wheel_position(int index) const { return {v_.wheel_x_m[index], v_.wheel_y_m[index], axle_z_m_}; }

  const Vehicle& v_;
  const VehicleSimConfig& c_;
  double axle_z_m_;
};

}  // namespace

std::string make_mjcf(const Vehicle& vehicle, const VehicleSimConfig& config) {
  return Writer(vehicle, config).model();
}

}  // namespace rover
