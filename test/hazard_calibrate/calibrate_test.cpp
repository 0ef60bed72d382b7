#include "tools/hazard_calibrate/calibrate.hpp"

#include <gtest/gtest.h>

#include "test/hazard_detector/scene.hpp"

namespace rover::hazard {
namespace {

struct Truth {
  double height_m, pitch_deg, roll_deg;
};

class CalibrateTest : public testing::TestWithParam<Truth> {
 protected:
  // Frames rendered with the true camera pose but labelled with the nominal mount.
  CalibrationFrames record(const Truth& truth, const synthetic::World& world, int frames) {
    StereoCamera actual = mount_;
    actual.T_body_cam.translation().z() = truth.height_m - kOriginHeightM;
    actual.T_body_cam.linear() = camera_rotation(to_rad(truth.pitch_deg), to_rad(truth.roll_deg));
    const auto exact = synthetic::exact_disparity(world, actual);
    synthetic::NoiseField noise(7);
    CalibrationFrames recorded{CalibrateConfig{}};
    for (int i = 0; i < frames; ++i) EXPECT_TRUE(recorded.add(noise.apply(exact, actual, 0.25, 0.1), mount_));
    return recorded;
  }

  static constexpr double kOriginHeightM = 0.62;
  StereoCamera mount_ = synthetic::loccam_camera();
};

TEST_P(CalibrateTest, FindsHeightPitchAndRoll) {
  synthetic::World pebbles;
  pebbles.rocks = {{1.3, 0.1, 0.05, 0.05}, {1.8, -0.3, 0.08, 0.08}, {2.3, 0.4, 0.1, 0.1}};
  const CalibrationFit fit = record(GetParam(), pebbles, 10).fit(kOriginHeightM);
  ASSERT_TRUE(fit.ok);
  EXPECT_NEAR(fit.calibration.height_m, GetParam().height_m, 0.002);
  EXPECT_NEAR(to_deg(fit.calibration.pitch_rad), GetParam().pitch_deg, 0.05);
  EXPECT_NEAR(to_deg(fit.calibration.roll_rad), GetParam().roll_deg, 0.05);
  EXPECT_LT(fit.rms_px, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Mounts, CalibrateTest,
                         testing::Values(Truth{0.679, 33.0, 0.0}, Truth{0.70, 34.5, 1.2}, Truth{0.62, 30.0, -3.0},
                                         Truth{0.75, 38.0, 4.0}));

TEST_F(CalibrateTest, RejectsGroundThatIsNotFlat) {
  synthetic::World world;
  world.relief = [](double x, double y) { return 0.15 * std::sin(4.0 * x) * std::cos(3.0 * y); };
  EXPECT_FALSE(record({0.679, 33.0, 0.0}, world, 3).fit(kOriginHeightM).ok);
}

TEST_F(CalibrateTest, RejectsTooLittleStereo) {
  CalibrationFrames frames{CalibrateConfig{}};
  EXPECT_TRUE(frames.add(Disparity(512, 384), mount_));
  const CalibrationFit fit = frames.fit(kOriginHeightM);
  EXPECT_FALSE(fit.ok);
  EXPECT_STREQ(fit.failure, "too few pixels with stereo");
}

TEST_F(CalibrateTest, RejectsFramesOfAnotherCamera) {
  CalibrationFrames frames{CalibrateConfig{}};
  EXPECT_TRUE(frames.add(Disparity(512, 384), mount_));
  StereoCamera other = mount_;
  other.focal_px += 1.0;
  EXPECT_FALSE(frames.add(Disparity(512, 384), other));
}

TEST_F(CalibrateTest, NominalCalibrationReproducesTheMount) {
  const StereoCamera again = calibrated_camera(mount_, nominal_calibration(mount_, kOriginHeightM), kOriginHeightM);
  EXPECT_TRUE(again.T_body_cam.isApprox(mount_.T_body_cam, 1e-12));
}

}  // namespace
}  // namespace rover::hazard
