// Stereo and hazard detection on rendered Martian terrain, with calibration error, sensor noise and shadows.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "common/core/frames.hpp"
#include "common/geo/elevation_map.hpp"
#include "common/stereo/stereo.hpp"
#include "hazard_detector/hazard_detector.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"
#include "rover_simulator/world/world.hpp"
#include "test/hazard_detector/scene.hpp"

namespace rover::hazard {
namespace {

class RenderedTest : public testing::Test {
 protected:
  explicit RenderedTest(double k = 0.0)
      : world_(make_world(k)), rig_(synthetic::loccam_rig()), cameras_(rig_, {}, world_, 77), stereo_({}, rig_, 0.62) {
    cv::setNumThreads(1);
  }

  static World make_world(double k) {
    WorldConfig config;
    config.rocks.k = k;
    return World(config,
                 read_elevation_map(ROVER_SOURCE_DIR "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif").raster, 5);
  }

  // Least-squares body pose with the six wheels on the ground (rocks ignored).
  Eigen::Isometry3d place_on_ground(const Pose2& at) const {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    const double c = std::cos(at.yaw_rad), s = std::sin(at.yaw_rad);
    for (double x : {0.75, 0.0, -0.75})
      for (double y : {0.41, -0.41}) {
        const Eigen::Vector3d a(1.0, x, y);
        A += a * a.transpose();
        b += a * world_.ground_height_m(at.x_m + c * x - s * y, at.y_m + s * x + c * y);
      }
    const Eigen::Vector3d plane = A.ldlt().solve(b);
    Eigen::Matrix3d R;
    R.col(0) = Eigen::Vector3d(1.0, 0.0, plane[1]).normalized();
    R.col(2) = Eigen::Vector3d(-plane[1], -plane[2], 1.0).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    R = (rotation_from_rpy(0.0, 0.0, at.yaw_rad) * R).eval();
    return make_pose(R, Eigen::Vector3d(at.x_m, at.y_m, plane[0]) + 0.62 * R.col(2));
  }

  HazardResult detect(const Eigen::Isometry3d& T_map_body) {
    const StereoCameraSim::Pair pair = cameras_.render(T_map_body, ++frame_);
    return detector_.step(stereo_.step(pair.left, pair.right)->disparity, stereo_.camera());
  }
  Map map(const HazardResult& result) const { return {detector_.shape(), result}; }

  World world_;
  StereoRig rig_;
  StereoCameraSim cameras_;
  stereo::Stereo stereo_;
  HazardDetector detector_{HazardConfig{}};
  int frame_ = 0;
};

class RocklessTest : public RenderedTest {};

TEST_F(RocklessTest, RoughGroundWithoutRocksIsClear) {
  for (const Pose2& start : {Pose2{60, 170, 0.5}, Pose2{120, 230, 2.4}, Pose2{90, 270, -1.2}, Pose2{200, 160, 3.0}})
    for (int i = 0; i < 8; ++i) {
      const double s = 0.5 * i;
      const HazardResult result = detect(place_on_ground(
          {start.x_m + s * std::cos(start.yaw_rad), start.y_m + s * std::sin(start.yaw_rad), start.yaw_rad}));
      EXPECT_EQ(result.status, Status::kClear) << start.x_m << " " << i;
      EXPECT_GT(result.coverage, 0.7) << start.x_m << " " << i;
    }
}

class RockFieldTest : public RenderedTest {
 protected:
  RockFieldTest() : RenderedTest(0.08) {}
};

TEST_F(RockFieldTest, DetectsTwentyCentimetreRocksBeforeContact) {
  int rocks = 0, frames = 0, hits = 0;
  for (const Rock& rock : world_.rocks_in(100, 200, 140, 240)) {
    if (rock.height_m < 0.20 || rock.height_m > 0.32) continue;
    const double yaw = 0.7 * rocks, offset = 0.25 * (rocks % 3 - 1);
    bool seen = false;
    for (double ahead : {2.2, 1.9, 1.6, 1.4}) {
      const double x = rock.x_m - ahead * std::cos(yaw) + offset * std::sin(yaw);
      const double y = rock.y_m - ahead * std::sin(yaw) - offset * std::cos(yaw);
      const HazardResult result = detect(place_on_ground({x, y, yaw}));
      const bool hit = map(result).count_near(is_hazard, ahead, offset, 0.5 * rock.diameter_m + 0.15) > 0;
      seen = seen || hit;
      hits += hit;
      ++frames;
    }
    EXPECT_TRUE(seen) << "rock of " << rock.height_m << " m at " << rock.x_m << " " << rock.y_m;
    if (++rocks == 10) break;
  }
  EXPECT_EQ(rocks, 10);
  EXPECT_GE(hits, 0.95 * frames) << hits << " of " << frames;
}

}  // namespace
}  // namespace rover::hazard
