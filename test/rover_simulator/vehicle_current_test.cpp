// Drive current over slope, compared with field data of a real rover.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <vector>

#include "vehicle_fixture.hpp"

namespace rover {
namespace {

struct Sample {
  double climb;  // sine of the pitch, uphill positive
  double current_a;
};

struct Line {
  double mean_climb = 0.0, mean_a = 0.0, slope_a = 0.0;
  double at(double climb) const { return mean_a + slope_a * (climb - mean_climb); }
};

Line fit(const std::vector<Sample>& samples) {
  Line line;
  for (const Sample& s : samples) {
    line.mean_climb += s.climb / static_cast<double>(samples.size());
    line.mean_a += s.current_a / static_cast<double>(samples.size());
  }
  double xx = 0.0, xy = 0.0;
  for (const Sample& s : samples) {
    xx += (s.climb - line.mean_climb) * (s.climb - line.mean_climb);
    xy += (s.climb - line.mean_climb) * (s.current_a - line.mean_a);
  }
  line.slope_a = xy / xx;
  return line;
}

// Right motors have the opposite sign; negative pitch is nose up.
std::vector<Sample> cuadriga() {
  std::ifstream file(ROVER_SOURCE_DIR "/test/rover_simulator/data/cuadriga_slopes.csv");
  std::vector<Sample> samples;
  for (std::string line; std::getline(file, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    double left, right, pitch_deg;
    if (fields >> left >> right >> pitch_deg) samples.push_back({std::sin(-to_rad(pitch_deg)), 0.5 * (left - right)});
  }
  return samples;
}

double mean_current_a(double slope_deg, double gravity_mps2) {
  const PlaneSurface plane(Soil::kFirm, to_rad(slope_deg));
  VehicleSimConfig config;
  config.gravity_mps2 = gravity_mps2;
  VehicleSim sim(test_vehicle(), config, plane, {});
  drive(sim, straight(0.15), 4.0);
  double sum = 0.0;
  for (double current : sim.truth().drive_current_a) sum += current / 6.0;
  return sum;
}

// What a slope adds to the current, over the mean current at the data's mean slope: free of either rover's size. The
// field trial's currents scatter by more than their mean (r = 0.57), and the two runs differ by 15 %: hence 30 %.
TEST(DriveCurrent, RiseWithSlopeMatchesFieldData) {
  constexpr double kEarth = 9.81;
  const std::vector<Sample> field = cuadriga();
  ASSERT_GT(field.size(), 1000u);
  const Line real = fit(field);
  std::vector<Sample> simulated;
  for (double deg : {2.0, 6.0, 10.0, 14.0, 18.0, 22.0})
    simulated.push_back({std::sin(to_rad(deg)), mean_current_a(deg, kEarth)});
  const Line ours = fit(simulated);
  const double real_rise = real.slope_a / real.mean_a;
  const double our_rise = ours.slope_a / ours.at(real.mean_climb);
  EXPECT_NEAR(our_rise, real_rise, 0.30 * real_rise);
  RecordProperty("real_rise", std::to_string(real_rise));
  RecordProperty("simulated_rise", std::to_string(our_rise));
}

// On Mars: about 0.7 A on level firm ground, the motors' nominal 3.17 A at about 20 degrees, far below the limit.
TEST(DriveCurrent, IsNearNominalOnMars) {
  const double level = mean_current_a(0.0, 3.71), steep = mean_current_a(20.0, 3.71);
  EXPECT_GT(level, 0.5);
  EXPECT_LT(level, 1.2);
  EXPECT_GT(steep, 2.0);
  EXPECT_LT(steep, 4.0);
}

TEST(DriveCurrent, IsLimited) {
  DriveMotor motor;
  MotorOutput out;
  for (int i = 0; i < 1000; ++i) out = motor.step({}, 10.0, 1.0, 0.0, 0.0, 0.002);
  EXPECT_EQ(out.current_a, 10.0);
  // No integrator windup while the wheel is blocked.
  out = motor.step({}, 10.0, -1.0, 0.0, 0.0, 0.002);
  for (int i = 0; i < 300; ++i) out = motor.step({}, 10.0, -1.0, 0.0, 0.0, 0.002);
  EXPECT_EQ(out.current_a, -10.0);
}

}  // namespace
}  // namespace rover
