// Report of the Full level, from a synthetic log with known metrics.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <rover/correction_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/truth_t.hpp>

#include "../common/temp_folder.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"
#include "known_run.hpp"
#include "message_log.hpp"
#include "tools/report/elevation_picture.hpp"
#include "tools/report/level_picture.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/report/metrics_json.hpp"
#include "tools/report/rasterise.hpp"

namespace rover::report {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

TEST(Mosaic, NewestObservationReplacesOlder) {
  ElevationMosaic mosaic;
  EXPECT_TRUE(mosaic.empty());
  EXPECT_TRUE(std::isnan(mosaic.at(0.0, 0.0)));
  mosaic.add(0.1, -0.2, -0.1, 3, {1.f, 2.f, 3.f, 4.f, kUnseen, 6.f});
  EXPECT_EQ(mosaic.at(-0.15, -0.05), 1.f);
  EXPECT_EQ(mosaic.at(0.05, -0.05), 3.f);
  EXPECT_EQ(mosaic.at(0.05, 0.05), 6.f);
  EXPECT_TRUE(std::isnan(mosaic.at(-0.05, 0.05)));
  EXPECT_TRUE(std::isnan(mosaic.at(5.0, 5.0)));
  mosaic.add(0.1, -0.1, 0.0, 2, {7.f, kUnseen});
  EXPECT_EQ(mosaic.at(-0.05, 0.05), 7.f);
  EXPECT_EQ(mosaic.at(0.05, 0.05), 6.f) << "not seen again, but seen before";
  EXPECT_NEAR(mosaic.bounds().x0_m, -0.2, 1e-9);
  EXPECT_NEAR(mosaic.bounds().y1_m, 0.1, 1e-9);
}

TEST(Mosaic, FitsTogetherAcrossItsTilesOnBothSidesOfZero) {
  ElevationMosaic mosaic;
  const auto height = [](double x, double y) { return static_cast<float>(0.3 * x - 0.1 * y); };
  for (const double corner : {-30.0, -10.0, 10.0}) {
    std::vector<float> map;
    for (int row = 0; row < 200; ++row)
      for (int column = 0; column < 200; ++column)
        map.push_back(height(corner + 0.1 * (column + 0.5), -10.0 + 0.1 * (row + 0.5)));
    mosaic.add(0.1, corner, -10.0, 200, map);
  }
  for (double x = -29.95; x < 30.0; x += 0.7)
    for (double y = -9.95; y < 10.0; y += 0.7) ASSERT_NEAR(mosaic.at(x, y), height(x, y), 0.03) << x << " " << y;
}

TEST(Mosaic, InvalidMapsAreIgnored) {
  ElevationMosaic mosaic;
  mosaic.add(kNaN, 0.0, 0.0, 1, {1.f});
  mosaic.add(0.0, 0.0, 0.0, 1, {1.f});
  mosaic.add(0.1, kNaN, 0.0, 1, {1.f});
  mosaic.add(0.1, 0.0, 1e12, 1, {1.f});
  mosaic.add(0.1, 0.0, 0.0, 0, {1.f});
  EXPECT_TRUE(mosaic.empty());
}

// The error at the first pose is not SLAM's. The growth after it is.
TEST(SlamDrift, IsMeasuredFromFirstPose) {
  RunRecord run = straight_run(20.0);
  for (PoseSample& pose : run.poses) pose.T_odom_body.translation().y() += 0.005 * 0.1 * pose.t_s;
  for (double t = 25.0; t <= 205.0; t += 5.0) run.slam.push_back({t, {3.0, -2.0 + 0.005 * 0.1 * (t - 25.0), 0.0}});
  EXPECT_NEAR(figures(run).slam_drift_percent, 1.0, 1e-6);
  EXPECT_NEAR(figures(run).slam_odometry_ratio, 2.0, 1e-6);
  const auto early = [](const PoseSample& pose) { return pose.t_s > 19.0 && pose.t_s < 30.0; };
  run.poses.erase(std::remove_if(run.poses.begin(), run.poses.end(), early), run.poses.end());
  EXPECT_TRUE(std::isfinite(figures(run).slam_odometry_ratio)) << "no pose yet when SLAM begins in the window";
  run.slam.resize(1);
  EXPECT_TRUE(std::isnan(figures(run).slam_drift_percent)) << "one pose has no drift";
}

TEST(Estimate, ErrorsCountFromTheBeginAndFromTheFirstAcceptedCorrection) {
  RunRecord run = straight_run(20.0);
  for (PoseSample& pose : run.poses) pose.T_map_odom.translation().y() = pose.t_s < 100.0 ? 2.0 : 0.3;
  Metrics m = figures(run);
  EXPECT_NEAR(m.estimate_error_max_m, 2.0, 1e-9);
  EXPECT_TRUE(std::isnan(m.corrected_error_max_m));
  run.corrections = {{40.0, false, {}, 41.0, "flat"}, {98.0, true, {0.0, 0.3, 0.0}, 99.9}};
  m = figures(run);
  EXPECT_NEAR(m.estimate_error_max_m, 2.0, 1e-9);
  EXPECT_NEAR(m.corrected_error_max_m, 0.3, 1e-9);
  EXPECT_EQ(m.global_corrections[0].reason, "flat");
}

// 10 m at each level, with 2 s and 6 s of CPU time.
TEST(Levels, DistanceTimeAndCpuPerLevel) {
  RunRecord run = straight_run(20.0);
  run.states = {{0.0, State::kStandby, false, ""},
                {5.0, State::kDriving, false, ""},
                {105.0, State::kDriving, true, "slow_progress", "effective_speed_mps", 0.05, 0.06},
                {205.0, State::kGoalReached, true, ""}};
  ServiceRecord& slam = run.services["slam"];
  for (double t = 0.0; t <= 205.0; t += 1.0)
    slam.heartbeats.push_back({t, 1, 7.0 + (t <= 5.0 ? 0.0 : t < 105.0 ? 0.02 * (t - 5.0) : 2.0 + 0.06 * (t - 105.0))});
  const Metrics m = figures(run);
  EXPECT_NEAR(m.efficient.travelled_m, 10.0, 0.06);
  EXPECT_NEAR(m.full.travelled_m, 10.0, 0.06);
  EXPECT_NEAR(m.efficient.time_s, 100.0, 1e-6);
  EXPECT_NEAR(m.services.at("slam").cpu_s_per_m_efficient, 0.2, 0.01);
  EXPECT_NEAR(m.services.at("slam").cpu_s_per_m_full, 0.6, 0.01);
  ASSERT_EQ(m.level_switches.size(), 1u);
  EXPECT_NEAR(m.level_switches[0].at_m, 10.0, 0.06);
  EXPECT_EQ(switch_text(m.level_switches[0]),
            "EFFICIENT to FULL: slow_progress, effective_speed_mps 0.05, threshold 0.06");
}

// 20 m along x at 0.2 m/s from 5 s on; at 10 m the level changes to Full, with maps and SLAM poses from then on.
class FullLogTest : public testing::Test {
 protected:
  FullLogTest() {
    MessageLog log(log_file_);
    for (Utime t = 0; t <= to_utime(106.0); t += to_utime(0.5)) put(log, t);
  }

  static double x_at(Utime t) { return std::clamp(0.2 * (to_seconds(t) - 5.0), 0.0, 20.0); }

  static void put(MessageLog& log, Utime t) {
    const Eigen::Isometry3d T = pose_at(x_at(t), 0.0);
    truth_t truth{};
    pose_to(T, truth.position_map_body_m, truth.quat_map_body_wxyz);
    truth.clearance_m = 1.0;
    log.put(channel::kTruth, truth, t, "rover_simulator");
    pose_t pose{};
    pose_to(T, pose.position_odom_body_m, pose.quat_odom_body_wxyz);
    pose_to(Eigen::Isometry3d::Identity(), pose.position_map_odom_m, pose.quat_map_odom_wxyz);
    log.put(channel::kPose, pose, t, "localization");
    put_state(log, t);
    if (x_at(t) >= 10.0 && t % to_utime(2.5) == 0) put_full(log, t);
  }

  static void put_state(MessageLog& log, Utime t) {
    supervisor_state_t state{};
    const bool done = x_at(t) >= 20.0;
    state.state = t < to_utime(5.0) ? supervisor_state_t::STANDBY
                  : done            ? supervisor_state_t::GOAL_REACHED
                                    : supervisor_state_t::DRIVING;
    state.level = x_at(t) >= 10.0 ? supervisor_state_t::FULL : supervisor_state_t::EFFICIENT;
    if (state.level == supervisor_state_t::FULL) {
      state.cause = "many_hazards";
      state.quantity = "hazards_per_m";
      state.value = 0.8;
      state.threshold = 0.5;
    }
    log.put(channel::kState, state, t, "supervisor");
  }

  static void put_full(MessageLog& log, Utime t) {
    slam_pose_t slam{};
    slam.drift_y_m = 0.005 * (x_at(t) - 10.0);
    log.put(channel::kSlamPose, slam, t, "slam");
    elevation_t map{};
    map.cell_m = 0.1;
    map.cells_x = map.cells_y = 200;
    map.size = 200 * 200;
    map.origin_x_m = std::floor(x_at(t)) - 10.0;
    map.origin_y_m = -10.0;
    for (int i = 0; i < map.size; ++i) {
      const double x = map.origin_x_m + 0.1 * (i % 200 + 0.5);
      map.height_m.push_back(i / 200 < 100 ? static_cast<float>(0.1 * x) : kUnseen);
      map.sigma_m.push_back(0.02f);
    }
    log.put(channel::kElevation, map, t, "slam");
    correction_t correction{};
    correction.accepted = x_at(t) == 15.0 ? 1 : 0;
    correction.y_m = 0.1;
    correction.reason = correction.accepted == 1 ? "" : "too flat";
    log.put(channel::kCorrection, correction, t, "global_localization", to_utime(0.3));
  }

  testing_support::TempFolder folder_;
  std::string log_file_ = folder_.file("traverse.lcm");
};

TEST_F(FullLogTest, FiguresFromTheLog) {
  const RunRecord run = read_log(choose_run(log_file_));
  EXPECT_NEAR(run.elevation.at(18.0, -3.0), 1.8, 0.02);
  EXPECT_TRUE(std::isnan(run.elevation.at(18.0, 3.0)));
  const RunEvaluation evaluation = evaluate(run, RunInfo{}, Footprint{}, std::nullopt);
  const nlohmann::ordered_json m = metrics_json(evaluation.metrics);
  EXPECT_NEAR(m["slam_drift_percent"], 0.5, 0.01);
  EXPECT_NEAR(m["levels"]["FULL"]["travelled_m"], 10.0, 0.2);
  ASSERT_EQ(m["level_switches"].size(), 1u);
  EXPECT_EQ(m["level_switches"][0]["to"], "FULL");
  EXPECT_EQ(m["level_switches"][0]["reason"], "many_hazards");
  EXPECT_EQ(m["level_switches"][0]["value"], 0.8);
  ASSERT_EQ(m["global_corrections"].size(), 21u);
  EXPECT_EQ(m["global_corrections"][0]["reason"], "too flat");
  int accepted = 0;
  for (const auto& correction : m["global_corrections"]) {
    if (correction["accepted"] != true) continue;
    ++accepted;
    EXPECT_NEAR(correction["correction_error_m"], 0.1, 1e-9);
    EXPECT_EQ(correction["after_m"], 0.0) << "POSE says that localization did not take it";
  }
  EXPECT_EQ(accepted, 1);
  EXPECT_EQ(m["corrected_error_max_m"], 0.0);
}

TEST_F(FullLogTest, PicturesShowMapTracksAndReasons) {
  const RunRecord run = read_log(choose_run(log_file_));
  const Footprint footprint;
  const std::optional<TrueWorld> world;
  const HeightRaster orbital;
  const RunEvaluation evaluation = evaluate(run, RunInfo{}, footprint, world);
  const Scene scene{run, evaluation, footprint, orbital, world};
  const std::string elevation = draw_elevation(scene);
  EXPECT_NE(elevation.find("SLAM"), std::string::npos);
  EXPECT_NE(elevation.find("0.00 to 0.00 m"), std::string::npos);
  const std::string levels = draw_levels(scene);
  EXPECT_NE(levels.find("EFFICIENT to FULL: many_hazards, hazards_per_m 0.8, threshold 0.5"), std::string::npos);
  write_png(elevation, 1.0, folder_.file("elevation.png"));
  write_png(levels, 1.0, folder_.file("levels.png"));
  EXPECT_GT(std::filesystem::file_size(folder_.file("elevation.png")), 10'000u);
  EXPECT_GT(std::filesystem::file_size(folder_.file("levels.png")), 10'000u);
}

TEST(FullPictures, ARunAtTheEfficientLevelHasNone) {
  const RunRecord run = straight_run(10.0);
  const Footprint footprint;
  const std::optional<TrueWorld> world;
  const HeightRaster orbital;
  const RunEvaluation evaluation = evaluate(run, RunInfo{}, footprint, world);
  const Scene scene{run, evaluation, footprint, orbital, world};
  EXPECT_EQ(draw_elevation(scene), "");
  EXPECT_EQ(draw_levels(scene), "");
}

}  // namespace
}  // namespace rover::report
