#include "global_localization/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <rover/correction_t.hpp>
#include <rover/ground_command_t.hpp>

#include "common/bus/convert.hpp"
#include "common/geo/elevation_map.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "global_localization/orbital_map_file.hpp"
#include "test/global_localization/synthetic_terrain.hpp"
#include "test/stereo/one_node_world.hpp"

namespace rover::global::test {
namespace {

namespace fs = std::filesystem;

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";
const std::string kGale = kConfig + "/terrain/gale/gale_hirise_dtm_1m_348x337.tif";
const Pose2 kTruth{95.0, 60.0, 2.1};

ElevationRaster raster_of(const Height& height, double cell_m) {
  const HeightGrid grid = orbital_of(height, cell_m);
  ElevationRaster raster = read_elevation_map(kGale).raster;  // for its projection
  raster.width = grid.lattice.columns;
  raster.height = grid.lattice.rows;
  raster.resolution_m = cell_m;
  raster.z_m = grid.z_m;
  return raster;
}

elevation_t message_of(const ElevationView& view) {
  elevation_t message{};
  message.cell_m = view.lattice.cell_m;
  message.origin_x_m = view.lattice.x0_m;
  message.origin_y_m = view.lattice.y0_m;
  message.cells_x = static_cast<std::int16_t>(view.lattice.columns);
  message.cells_y = static_cast<std::int16_t>(view.lattice.rows);
  message.size = static_cast<std::int32_t>(view.z_m.size());
  message.height_m = view.z_m;
  message.sigma_m = view.sigma_m;
  message.brightness = view.brightness;
  message.picture_size = static_cast<std::int32_t>(view.brightness.size());
  return message;
}

class GlobalLocalizationNodeTest : public testing::Test {
 protected:
  GlobalLocalizationNodeTest()
      : dir_(fs::path(testing::TempDir()) /
             (std::string("global_localization_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(dir_);
    fs::create_directories(dir_);
  }

  // Uses the orbital map written so far.
  void start(int level = supervisor_state_t::FULL) {
    world_ = std::make_unique<rover::test::OneNodeWorld>("global_localization", dir_.string());
    service_ = make_global_localization(world_->node(), kConfig);
    world_->record(channel::kCorrection, corrections_);
    world_->record(channel::kHeartbeat, heartbeats_);
    world_->tick(now_);
    set_level(level);
  }
  void write_map(const Height& height = hills) {
    write_geotiff((dir_ / "orbital_map.tif").string(), raster_of(height, 0.5));
  }

  void set_level(int level) {
    supervisor_state_t state{};
    state.state = supervisor_state_t::DRIVING;
    state.level = static_cast<std::int8_t>(level);
    world_->send(channel::kState, state, now_);
  }

  // Pose with an error of (3, -2) m and 4 deg.
  pose_t pose(double sigma_m = 1.0) const {
    pose_t message{};
    pose_to(make_pose(Eigen::Matrix3d::Identity(), {place_.x(), place_.y(), 1.0}), message.position_odom_body_m,
            message.quat_odom_body_wxyz);
    pose_to(from_planar(perturbed_transform(kTruth, place_, {3.0, -2.0}, to_rad(4.0))), message.position_map_odom_m,
            message.quat_map_odom_wxyz);
    Matrix6d cov = Matrix6d::Zero();
    cov.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, 0.1, 0.001, 0.001, 0.002;
    matrix6_to(cov, message.covariance);
    message.travelled_m = travelled_m_;
    return message;
  }
  elevation_t elevation() const { return message_of(view_of(hills, kTruth, place_)); }

  // A pose, and a map 0.1 s old.
  void publish_inputs(const pose_t& pose_message, elevation_t map, double age_s = 0.1) {
    now_ += 1'000'000;
    world_->send(channel::kPose, pose_message, now_ - kTickUs);
    world_->send(channel::kElevation, std::move(map), now_ - to_utime(age_s), now_);
    world_->tick(now_);
    world_->tick(now_ + 800'000);
  }
  void set_start_pose(double sigma_m) {
    ground_command_t command{};
    command.kind = ground_command_t::SET_START_POSE;
    world_->send(channel::kGroundCommand, command, now_);
    stand(sigma_m);
  }
  // 2 s of POSE.
  void stand(double sigma_m) {
    for (int k = 0; k < 20; ++k) {
      now_ += 100'000;
      world_->send(channel::kPose, pose(sigma_m), now_ - kTickUs);
      world_->tick(now_);
    }
  }
  void drive(double metres) {
    for (double s = 0.0; s < metres; s += 4.0) {
      place_.x() += 4.0;
      travelled_m_ += 4.0;
      publish_inputs(pose(), elevation());
    }
  }
  // 16 m of a plain that shows marks.
  void drive_over_marks() {
    for (int k = 0; k < 4; ++k) {
      place_.x() += 4.0;
      travelled_m_ += 4.0;
      ElevationView view = view_of(level, kTruth, place_);
      view.brightness = view_of(marks, kTruth, place_).z_m;
      publish_inputs(pose(), message_of(view));
    }
  }

  fs::path dir_;
  std::unique_ptr<rover::test::OneNodeWorld> world_;
  std::shared_ptr<GlobalLocalizationNode> service_;
  std::vector<correction_t> corrections_;
  std::vector<heartbeat_t> heartbeats_;
  Utime now_ = 200'000;
  Eigen::Vector2d place_{0.0, -14.0};
  double travelled_m_ = 50.0;
};

TEST_F(GlobalLocalizationNodeTest, CorrectsAfterFirstDistanceAndAgainAfterInterval) {
  write_map();
  start();
  drive(12.0);
  EXPECT_TRUE(corrections_.empty());
  drive(4.0);
  ASSERT_EQ(corrections_.size(), 1u);
  const correction_t& c = corrections_[0];
  EXPECT_EQ(c.accepted, 1) << c.reason;
  EXPECT_EQ(c.header.utime, now_ - 100'000);
  EXPECT_EQ(c.header.release_utime, now_ + 500'000);
  const Eigen::Vector2d off = transformed({c.x_m, c.y_m, c.yaw_rad}, place_) - transformed(kTruth, place_);
  EXPECT_LT(off.norm(), 0.1);
  EXPECT_NEAR(c.yaw_rad, kTruth.yaw_rad, to_rad(0.2));
  EXPECT_GT(c.covariance[0], 0.0);
  EXPECT_GT(c.score, c.second_score);
  drive(16.0);
  EXPECT_EQ(corrections_.size(), 1u);
  drive(4.0);
  EXPECT_EQ(corrections_.size(), 2u);
}

// By a start pose of the operator, while stationary.
TEST_F(GlobalLocalizationNodeTest, TheRoverIsSearchedForAtOnceAfterAStartPose) {
  write_map();
  start();
  set_start_pose(1.0);
  EXPECT_TRUE(corrections_.empty()) << "without a map, and not lost";
  drive(16.0);
  ASSERT_EQ(corrections_.size(), 1u);
  for (const double sigma_m : {1.0, 20.0, 20.0}) {
    set_start_pose(sigma_m);
    EXPECT_EQ(corrections_.back().accepted, 1) << corrections_.back().reason;
  }
  EXPECT_EQ(corrections_.size(), 4u) << "once for each command";
}

TEST_F(GlobalLocalizationNodeTest, ARoverLostFromTheStartIsSearchedForWhenAMapComes) {
  write_map();
  start();
  set_start_pose(20.0);
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].reason, "local map too small");
  for (int maps = 0; maps < 2; ++maps) {
    publish_inputs(pose(20.0), elevation());
    stand(20.0);
  }
  ASSERT_EQ(corrections_.size(), 2u) << "stationary, and once when there is a map";
  EXPECT_NE(corrections_[1].reason, "local map too small");
}

TEST_F(GlobalLocalizationNodeTest, IsIdleAtLevelEfficient) {
  write_map();
  start(supervisor_state_t::EFFICIENT);
  drive(40.0);
  EXPECT_TRUE(corrections_.empty());
  set_level(supervisor_state_t::FULL);
  drive(16.0);
  EXPECT_EQ(corrections_.size(), 1u);
}

TEST_F(GlobalLocalizationNodeTest, RejectedCorrectionGivesReasonAndRepeatsPrior) {
  write_map([](double, double) { return 2.0; });
  start();
  drive(16.0);
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].accepted, 0);
  EXPECT_FALSE(corrections_[0].reason.empty());
  const Pose2 prior = perturbed_transform(kTruth, place_, {3.0, -2.0}, to_rad(4.0));
  EXPECT_NEAR(corrections_[0].x_m, prior.x_m, 1e-9);
  EXPECT_NEAR(corrections_[0].y_m, prior.y_m, 1e-9);
  EXPECT_NEAR(corrections_[0].yaw_rad, prior.yaw_rad, 1e-9);
  drive(8.0);  // the retry interval is shorter than after a fix
  EXPECT_EQ(corrections_.size(), 2u);
}

TEST_F(GlobalLocalizationNodeTest, MissingOrbitalMapIsDegradedAndRejected) {
  start();
  drive(16.0);
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].accepted, 0);
  EXPECT_EQ(corrections_[0].reason, "no orbital map");
  ASSERT_FALSE(heartbeats_.empty());
  EXPECT_EQ(heartbeats_.back().status, +heartbeat_t::DEGRADED);
  EXPECT_NE(heartbeats_.back().text.find("orbital_map.tif"), std::string::npos) << heartbeats_.back().text;
}

TEST_F(GlobalLocalizationNodeTest, MapDamagedDuringTheDriveIsDegradedAndRejected) {
  write_map();
  start();
  fs::resize_file(dir_ / "orbital_map.tif", 1000);
  drive(16.0);
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].accepted, 0);
  EXPECT_EQ(corrections_[0].reason, "orbital map cannot be read");
  EXPECT_EQ(heartbeats_.back().status, +heartbeat_t::DEGRADED);
}

TEST_F(GlobalLocalizationNodeTest, InvalidElevationIsCountedAndIgnored) {
  write_map();
  start();
  drive(12.0);
  std::vector<elevation_t> bad(6, elevation());
  bad[0].cell_m = kNaN;
  bad[1].cells_x = 100;
  bad[2].origin_x_m = kInfinity;
  bad[3].cell_m = 0.2;
  bad[4].cells_y = -3;
  bad[5].picture_size = 1;
  bad[5].brightness = {1.0f};
  for (const elevation_t& map : bad) publish_inputs(pose(), map);
  now_ += 10'000'000;
  publish_inputs(pose(), elevation(), 5.0);   // stale
  publish_inputs(pose(), elevation(), -0.5);  // from the future
  EXPECT_EQ(world_->malformed(channel::kElevation), 8);
  drive(4.0);
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].accepted, 1) << corrections_[0].reason;
}

TEST_F(GlobalLocalizationNodeTest, EmptyMapsAndInvalidPosesGiveNoCorrection) {
  write_map();
  start();
  pose_t broken = pose();
  broken.position_odom_body_m[0] = kNaN;
  pose_t lost = pose();
  lost.status = pose_t::LOST;
  for (int k = 0; k < 3; ++k) {
    publish_inputs(broken, elevation());
    publish_inputs(lost, elevation());
  }
  EXPECT_TRUE(corrections_.empty());
  for (int k = 0; k < 5; ++k) {
    travelled_m_ += 4.0, place_.x() += 4.0;
    publish_inputs(pose(), message_of(view_of(hills, kTruth, place_, [](int, int) { return false; })));
  }
  ASSERT_GE(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].reason, "local map too small");
}

TEST_F(GlobalLocalizationNodeTest, OdometryJumpClearsLocalMap) {
  write_map();
  start();
  drive(12.0);
  place_.y() += 9.0;
  drive(4.0);
  EXPECT_TRUE(corrections_.empty());  // 4 m after the new beginning
  drive(12.0);
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].accepted, 1) << corrections_[0].reason;
}

// Localization without its checkpoint begins odom anew, as far back as the rover had driven.
TEST_F(GlobalLocalizationNodeTest, OdometryThatBeginsAnewClearsLocalMap) {
  write_map();
  start();
  drive(8.0);
  place_.x() -= travelled_m_;
  travelled_m_ = 0.0;
  drive(8.0);
  EXPECT_TRUE(corrections_.empty());  // 8 m after the new beginning
  drive(8.0);
  EXPECT_EQ(corrections_.size(), 1u);
}

TEST_F(GlobalLocalizationNodeTest, InvalidOrbitalMapIsNamedInError) {
  const std::string file = (dir_ / "orbital_map.tif").string();
  const auto refusal = [&]() -> std::string {
    try {
      open_orbital_map(dir_.string());
    } catch (const DtmError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal().find("not found"), std::string::npos);
  std::ofstream(file) << "no map";
  EXPECT_NE(refusal().find("not a readable"), std::string::npos);
  ElevationRaster raster = raster_of(hills, 0.5);
  raster.projection_wkt.clear();
  write_geotiff(file, raster);
  EXPECT_NE(refusal().find("no georeference"), std::string::npos);
  raster = raster_of(hills, 0.5);
  raster.resolution_m = 1e-5;  // degrees
  write_geotiff(file, raster);
  EXPECT_NE(refusal().find("0.1 to 5 m"), std::string::npos);
  raster = raster_of(hills, 0.5);
  raster.z_m[7] = static_cast<float>(kNaN);
  write_geotiff(file, raster);
  EXPECT_EQ(refusal(), "");
  const OrbitalMap map = open_orbital_map(dir_.string());
  EXPECT_EQ(map.around({4.0, 4.0}, 8.0).weight[7], 0.0f);
}

// The picture begins 10 m east and 5 m north of the map's corner.
TEST_F(GlobalLocalizationNodeTest, PictureLocatesTheRoverOnAPlain) {
  write_map(level);
  const auto shifted = [](double x, double y) { return marks(x + 10.0, y + 5.0); };
  ElevationRaster picture = raster_of(shifted, 0.25);
  picture.west_m += 10.0;
  picture.south_m += 5.0;
  write_geotiff((dir_ / "orbital_picture.tif").string(), picture);
  start();
  drive_over_marks();
  ASSERT_EQ(corrections_.size(), 1u);
  const correction_t& c = corrections_[0];
  ASSERT_EQ(c.accepted, 1) << c.reason;
  EXPECT_EQ(c.layer, +correction_t::PICTURE);
  const Pose2 found{c.x_m, c.y_m, c.yaw_rad};
  EXPECT_LT((transformed(found, place_) - transformed(kTruth, place_)).norm(), 0.15);
}

TEST_F(GlobalLocalizationNodeTest, WithoutAReadablePictureReliefDoes) {
  write_map();
  std::ofstream(dir_ / "orbital_picture.tif") << "no picture";
  start();
  drive(16.0);
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].accepted, 1) << corrections_[0].reason;
  EXPECT_EQ(corrections_[0].layer, +correction_t::HEIGHT);
  world_->tick(now_ += 1'000'000);
  ASSERT_FALSE(heartbeats_.empty());
  EXPECT_EQ(heartbeats_.back().status, +heartbeat_t::DEGRADED);
  EXPECT_NE(heartbeats_.back().text.find("orbital_picture.tif: not a readable"), std::string::npos);
}

TEST_F(GlobalLocalizationNodeTest, ADamagedPictureDoesNotTakeReliefWithIt) {
  write_map(level);
  write_geotiff((dir_ / "orbital_picture.tif").string(), raster_of(marks, 0.25));
  start();
  fs::resize_file(dir_ / "orbital_picture.tif", 1000);
  drive_over_marks();
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].reason, "not enough relief; picture: orbital picture cannot be read");
}

TEST_F(GlobalLocalizationNodeTest, RejectionNamesReliefAndPicture) {
  write_map(level);
  write_geotiff((dir_ / "orbital_picture.tif").string(), raster_of(marks, 0.25));
  start();
  for (int k = 0; k < 4; ++k) {
    place_.x() += 4.0;
    travelled_m_ += 4.0;
    publish_inputs(pose(), message_of(view_of(level, kTruth, place_)));
  }
  ASSERT_EQ(corrections_.size(), 1u);
  EXPECT_EQ(corrections_[0].reason, "not enough relief; picture: local picture too small");
}

class GlobalLocalizationConfigTest : public testing::Test {};

TEST_F(GlobalLocalizationConfigTest, UnknownKeysAndBadRangesStopStartUp) {
  const fs::path dir = fs::path(testing::TempDir()) / "global_localization_config";
  fs::create_directories(dir);
  const auto write = [&](const std::string& text) { std::ofstream(dir / "global_localization.yaml") << text; };
  write("search: {min_half_width_m: 13}\n");
  EXPECT_DOUBLE_EQ(load_config(dir.string()).core.search.min_half_width_m, 13.0);
  for (const char* bad : {"search: {half_width: 3}\n", "search: {min_half_width_m: -1}\n",
                          "search: {max_half_width_m: 5}\n", "latency_s: fast\n"}) {
    write(bad);
    EXPECT_THROW(load_config(dir.string()), ConfigError) << bad;
  }
}

// Measured terrain with a coarser, noisy orbital map.
TEST(GlobalLocalizationOnGale, CorrectsPoseOnFeaturedTerrain) {
  const ElevationRaster gale = read_elevation_map(kGale).raster;
  const auto height = [&](double x, double y) {
    const double u = x - 0.5, v = y - 0.5;
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const double a = u - i, b = v - j;
    return (1 - b) * ((1 - a) * gale.at(i, j) + a * gale.at(i + 1, j)) +
           b * ((1 - a) * gale.at(i, j + 1) + a * gale.at(i + 1, j + 1));
  };
  const NodeConfig config = load_config(kConfig);
  const Pose2 truth{171.0, 165.0, -0.6};
  const auto shifted = [&](double x, double y) { return height(x + 100.0, y + 100.0); };
  GlobalLocalization core(config.core, orbital_of(shifted, 1.0, 0.1), kCellM);
  const Pose2 on_map{truth.x_m - 100.0, truth.y_m - 100.0, truth.yaw_rad};
  Eigen::Vector2d p(0.0, 0.0);
  for (; p.x() <= 48.0; p.x() += 6.0) core.add_elevation(view_of(shifted, on_map, p), p);
  p.x() -= 6.0;
  const Correction c = core.correct({perturbed_transform(on_map, p, {-5.0, 6.0}, to_rad(-7.0)), p, pose_cov()});
  ASSERT_TRUE(c.accepted) << c.reason;
  EXPECT_LT((transformed(c.T_map_odom, p) - transformed(on_map, p)).norm(), 0.5);
  EXPECT_NEAR(c.T_map_odom.yaw_rad, on_map.yaw_rad, to_rad(1.0));
}

}  // namespace
}  // namespace rover::global::test
