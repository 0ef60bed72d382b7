// The geometric tier of perception against geometry that is known.
#include <gtest/gtest.h>

#include <cmath>

#include "camera_test_world.hpp"
#include "rover_simulator/camera/calibration_error.hpp"
#include "rover_simulator/camera/geometric_view.hpp"

namespace rover {
namespace {

// A box on level ground.
class StepSurface : public Surface {
 public:
  double height_m(double x, double y) const override { return rises(x, y) ? 0.3 : 0.0; }
  Material material(double, double) const override { return {Soil::kFirm, -1, 0.0}; }
  static bool rises(double x, double y) { return x > 2.0 && x < 2.5 && std::abs(y) < 0.25; }
};

const Eigen::Isometry3d kOnGround = make_pose(Eigen::Matrix3d::Identity(), {0.0, 0.0, 0.62});

struct Camera {
  explicit Camera(const Surface& world, double calibration_error_px = 0.0)
      : rig(test::loccam_rig()),
        rectified(stereo::Stereo({}, rig, 0.62).camera()),
        view(world, {.textureless_fraction = 0.0, .textureless_rock_fraction = 0.0}),
        stereo(rig, with_calibration_error(rig, calibration_error_px, 5), rectified, view.scene()),
        errors(errors_of({}, rectified), rig.width, rig.height, 5) {}

  std::vector<float> exact() { return stereo.exact_px(kOnGround * rig.T_body_left); }
  Disparity measured(std::int64_t frame = 0) {
    return view.expose(stereo, errors, ground_reference(rectified, 0.62), kOnGround * rig.T_body_left, frame);
  }
  float exact_at(const std::vector<float>& px, int u, int v) const {
    return px[static_cast<size_t>(v) * rectified.width + u];
  }

  StereoRig rig;
  StereoCamera rectified;
  GeometricView view;
  GeometricStereo stereo;
  DisparityErrors errors;
};

TEST(GeometricStereo, LevelGroundHasTheDisparityOfItsPlane) {
  const test::PlaneSurface ground;
  Camera camera(ground);
  const std::vector<float> px = camera.exact();
  const DisparityPlane plane = ground_reference(camera.rectified, 0.62);
  for (int v = 80; v < camera.rectified.height; v += 16)
    for (int u = 0; u < camera.rectified.width; u += 16)
      ASSERT_NEAR(camera.exact_at(px, u, v), plane.at(u, v), 0.03) << u << " " << v;
}

TEST(GeometricStereo, CalibrationErrorsChangeTheDisparity) {
  const test::PlaneSurface ground;
  Camera camera(ground, 0.2);
  const std::vector<float> px = camera.exact();
  const DisparityPlane plane = ground_reference(camera.rectified, 0.62);
  double largest = 0.0;
  for (int v = 80; v < camera.rectified.height; v += 16)
    for (int u = 0; u < camera.rectified.width; u += 16)
      largest = std::max(largest, std::abs(camera.exact_at(px, u, v) - plane.at(u, v)));
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(largest, 2.0);
}

TEST(GeometricView, NoiseHasItsSizeAndDependsOnTheFrame) {
  const test::PlaneSurface ground;
  Camera camera(ground);
  const std::vector<float> exact = camera.exact();
  const Disparity first = camera.measured(1);
  double sum_of_squares = 0.0;
  int count = 0;
  for (int v = 250; v < 370; ++v)
    for (int u = 150; u < 400; ++u) {
      ASSERT_TRUE(first.valid(u, v)) << u << " " << v;
      sum_of_squares += std::pow(first.px(u, v) - camera.exact_at(exact, u, v), 2);
      ++count;
    }
  EXPECT_NEAR(std::sqrt(sum_of_squares / count), 0.085, 0.025);
  EXPECT_EQ(camera.measured(1).px16, first.px16);
  EXPECT_NE(camera.measured(2).px16, first.px16);
}

TEST(GeometricView, WhatTheRightImageDoesNotShowIsInvalid) {
  const test::PlaneSurface ground;
  Camera camera(ground);
  const Disparity disparity = camera.measured();
  EXPECT_FALSE(disparity.valid(20, 300));  // its disparity is some 45 px
  EXPECT_TRUE(disparity.valid(120, 300));
}

TEST(GeometricView, ARockIsFramedByAHole) {
  const StepSurface world;
  Camera camera(world);
  const std::vector<float> exact = camera.exact();
  const Disparity disparity = camera.measured();
  int rims = 0;
  for (int u = 200; u < 380; ++u)
    for (int v = 10; v < 300; ++v) {
      const float above = camera.exact_at(exact, u, v - 1);
      if (camera.exact_at(exact, u, v) - above < 4.0F) continue;
      ++rims;  // the box's upper edge: ground behind it in the row above
      EXPECT_NEAR(disparity.px(u, v), camera.exact_at(exact, u, v), 1.0) << u << " " << v;
      EXPECT_FALSE(disparity.valid(u, v - 3)) << u << " " << v;
    }
  EXPECT_GT(rims, 20);
}

TEST(GeometricView, DustIsNotMatched) {
  const test::PlaneSurface ground;
  Camera dusty(ground);
  GeometricView all_dust(ground, {.textureless_fraction = 1.0});
  const Disparity disparity = all_dust.expose(dusty.stereo, dusty.errors, ground_reference(dusty.rectified, 0.62),
                                              kOnGround * dusty.rig.T_body_left, 0);
  EXPECT_EQ(std::count_if(disparity.px16.begin(), disparity.px16.end(), [](int px16) { return px16 > 0; }), 0);
}

// The same box as a rock.
class StepOfRock : public StepSurface {
 public:
  Material material(double x, double y) const override {
    return rises(x, y) ? Material{Soil::kBedrock, 7, 0.3} : Material{Soil::kFirm, -1, 0.0};
  }
};

TEST(GeometricView, ADustyRockIsMatchedAtItsOutlineOnly) {
  const StepOfRock world;
  Camera camera(world);
  GeometricView dusty(world, {.textureless_fraction = 0.0, .textureless_rock_fraction = 1.0});
  const std::vector<float> exact = camera.exact();
  const Disparity disparity = dusty.expose(camera.stereo, camera.errors, ground_reference(camera.rectified, 0.62),
                                           kOnGround * camera.rig.T_body_left, 0);
  const auto is_rim = [&](int u, int v) {
    return camera.exact_at(exact, u, v) - camera.exact_at(exact, u, v - 1) > 4.0F;
  };
  int rims = 0, matched_rims = 0, matched_inside = 0;
  for (int u = 200; u < 380; ++u)
    for (int v = 10; v < 300; ++v)
      if (is_rim(u, v)) {
        ++rims;
        matched_rims += disparity.valid(u, v + 1) ? 1 : 0;
        matched_inside += disparity.valid(u, v + 25) ? 1 : 0;
      }
  EXPECT_GT(rims, 20);
  EXPECT_GT(matched_rims, rims / 2);
  EXPECT_LT(matched_inside, rims / 4);
}

}  // namespace
}  // namespace rover
