// Complete camera model: geometry, light, determinism.
#include <gtest/gtest.h>

#include <cmath>

#include "camera_test_world.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"

namespace rover {
namespace {

using test::body_at;
using test::loccam_rig;

CameraSimConfig small_config() {
  CameraSimConfig config;
  config.scene = test::small_scene();
  return config;
}

// Without noise, calibration error and dust.
CameraSimConfig quiet_config() {
  CameraSimConfig config = small_config();
  config.calibration_error_px = 0.0;
  config.imager.full_well_e = 1e12;
  config.imager.read_noise_e = 0.0;
  config.scene.appearance.textureless_fraction = 0.0;
  return config;
}

bool same_bytes(const StereoCameraSim::Pair& a, const StereoCameraSim::Pair& b) {
  return a.left.data == b.left.data && a.right.data == b.right.data && a.exposure_s == b.exposure_s;
}

double rms_difference(const GrayImage& a, const GrayImage& b) {
  double squares = 0.0;
  for (size_t i = 0; i < a.data.size(); ++i) squares += std::pow(double{1} * a.data[i] - b.data[i], 2);
  return std::sqrt(squares / static_cast<double>(a.data.size()));
}

TEST(StereoCameraSim, ImageIsIdenticalForAnyThreadCount) {
  const test::RockySurface surface;
  CameraSimConfig config = small_config();
  config.scene.threads = 1;
  StereoCameraSim alone(loccam_rig(), config, surface, 7);
  config.scene.threads = 3;
  StereoCameraSim shared(loccam_rig(), config, surface, 7);
  for (int frame = 0; frame < 3; ++frame) {
    const Eigen::Isometry3d T_map_body = body_at(surface, 50.0 + 0.3 * frame, -20.0, 0.4 * frame);
    EXPECT_TRUE(same_bytes(alone.render(T_map_body, frame), shared.render(T_map_body, frame)));
  }
}

TEST(StereoCameraSim, ImageDoesNotDependOnPreviousPositions) {
  const test::RockySurface surface;
  const CameraSimConfig config = small_config();
  const auto travelled = std::make_shared<TileScene>(surface, config.scene);
  for (double x = 80.0; x < 100.0; x += 1.0) travelled->focus(x, 30.0);
  const auto fresh = std::make_shared<TileScene>(surface, config.scene);
  StereoCameraSim a(loccam_rig(), config, travelled, 7);
  StereoCameraSim b(loccam_rig(), config, fresh, 7);
  const Eigen::Isometry3d T_map_body = body_at(surface, 100.0, 30.0, 0.3);
  EXPECT_TRUE(same_bytes(a.render(T_map_body, 0), b.render(T_map_body, 0)));
}

TEST(StereoCameraSim, RangesMatchAnalyticPlane) {
  const test::PlaneSurface surface(-4460.0, 0.08, -0.05);
  StereoCameraSim camera(loccam_rig(), quiet_config(), surface, 1);
  const Eigen::Isometry3d T_map_left = body_at(surface, 213.3, 151.7, 0.7) * camera.true_rig().T_body_left;
  const std::vector<float> ranges = camera.left_ranges_m(T_map_left);
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.08, 0.05, 1.0).normalized();
  const Eigen::Vector3d eye = T_map_left.translation();
  const double height = (eye.z() - surface.height_m(eye.x(), eye.y())) * normal.z();
  double worst = 0.0;
  for (int v = 0; v < 384; ++v) {
    for (int u = 0; u < 512; ++u) {
      const Eigen::Vector3d ray = T_map_left.linear() * ray_of_pixel(camera.true_rig().left, {u, v}).normalized();
      const double expected = -height / ray.dot(normal);
      worst = std::max(worst, std::abs(ranges[v * 512 + u] - expected) / expected);
    }
  }
  EXPECT_LT(worst, 2e-4);
}

// First point of the ray below the surface: steps of 4 mm, then bisection.
double marched_range_m(const Surface& surface, const Eigen::Vector3d& eye, const Eigen::Vector3d& ray, double limit_m) {
  const auto below = [&](double t) {
    const Eigen::Vector3d p = eye + t * ray;
    return p.z() < surface.height_m(p.x(), p.y());
  };
  double t = 0.3;
  while (t < limit_m && !below(t)) t += 0.004;
  double from = t - 0.004;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (from + t);
    (below(middle) ? t : from) = middle;
  }
  return t;
}

TEST(StereoCameraSim, RangesMatchRayMarchedSurface) {
  const test::RockySurface surface;
  StereoCameraSim camera(loccam_rig(), quiet_config(), surface, 1);
  const Eigen::Isometry3d T_map_left = body_at(surface, 213.3, 151.7, 0.7) * camera.true_rig().T_body_left;
  const std::vector<float> ranges = camera.left_ranges_m(T_map_left);
  int near = 0;
  int count = 0;
  for (int v = 3; v < 384; v += 16) {
    for (int u = 5; u < 512; u += 16) {
      const Eigen::Vector3d ray = T_map_left.linear() * ray_of_pixel(camera.true_rig().left, {u, v}).normalized();
      const double expected = marched_range_m(surface, T_map_left.translation(), ray, 10.0);
      if (std::abs(ranges[v * 512 + u] - expected) < 0.004 * expected) ++near;
      ++count;
    }
  }
  // The remaining rays hit rock rims, which the mesh samples at 2 cm.
  EXPECT_GT(near, 0.97 * count);
}

TEST(StereoCameraSim, NoGapsBetweenTiles) {
  const test::RockySurface surface;
  CameraSimConfig config = quiet_config();
  config.scene.far_radius_m = 80.0;
  StereoCameraSim camera(test::navcam_rig(), config, surface, 1);
  for (double yaw : {0.0, 1.1, 2.9, -2.0}) {
    const Eigen::Isometry3d T_map_left = body_at(surface, 212.0, 152.0, yaw) * camera.true_rig().T_body_left;
    const std::vector<float> ranges = camera.left_ranges_m(T_map_left);
    for (int v = 0; v < 480; ++v) {
      for (int u = 0; u < 640; ++u) {
        const Eigen::Vector3d ray = T_map_left.linear() * ray_of_pixel(camera.true_rig().left, {u, v}).normalized();
        if (ray.z() > -0.06) continue;
        ASSERT_LT(ranges[v * 640 + u], 60.0F) << u << ' ' << v;
      }
    }
  }
}

// Smooth dust with one flat disc of rock.
class DiscSurface : public test::PlaneSurface {
 public:
  Material material(double x, double y) const override {
    return {Soil::kFirm, std::hypot(x - 2.4, y - 0.3) < 0.071 ? 5 : -1, 0.0};
  }
};

// Of what differs from the dust.
Eigen::Vector2d disc_centroid(const GrayImage& image) {
  const double dust = mean_grey(image);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if (std::abs(image.at(u, v) - dust) < 9.0) continue;
      sum += Eigen::Vector2d(u, v);
      count += 1.0;
    }
  }
  return sum / count;
}

TEST(StereoCameraSim, KnownPointsProjectToExpectedPixels) {
  const DiscSurface surface;
  CameraSimConfig config = quiet_config();
  config.imager.vignetting = 0.0;
  config.scene.appearance.textureless_fraction = 1.0;
  config.scene.appearance.textureless_rock_fraction = 0.0;
  StereoCameraSim camera(loccam_rig(), config, surface, 1);
  const Eigen::Isometry3d T_map_body = body_at(surface, 0.0, 0.0);
  const StereoCameraSim::Pair pair = camera.render(T_map_body, 0);
  const StereoRig& rig = camera.true_rig();
  const Eigen::Isometry3d T_left_map = (T_map_body * rig.T_body_left).inverse();
  const Eigen::Vector3d p_left = T_left_map * Eigen::Vector3d(2.4, 0.3, 0.0);
  EXPECT_LT((disc_centroid(pair.left) - project(rig.left, p_left)).norm(), 0.6);
  EXPECT_LT((disc_centroid(pair.right) - project(rig.right, rig.T_left_right.inverse() * p_left)).norm(), 0.6);
}

TEST(StereoCameraSim, SeedAndFrameNumberChangeOnlyNoise) {
  const test::RockySurface surface;
  CameraSimConfig config = small_config();
  config.calibration_error_px = 0.0;
  const auto scene = std::make_shared<TileScene>(surface, config.scene);
  StereoCameraSim a(loccam_rig(), config, scene, 1);
  StereoCameraSim b(loccam_rig(), config, scene, 2);
  StereoCameraSim c(loccam_rig(), config, scene, 1);
  const Eigen::Isometry3d T_map_body = body_at(surface, 10.0, 10.0);
  const StereoCameraSim::Pair first = a.render(T_map_body, 0);
  for (const StereoCameraSim::Pair& other : {b.render(T_map_body, 0), c.render(T_map_body, 1)}) {
    const double rms = rms_difference(first.left, other.left);
    EXPECT_GT(rms, 1.0);
    EXPECT_LT(rms, 2.5);
  }
}

TEST(StereoCameraSim, ExposureAdaptsToSunElevation) {
  const test::PlaneSurface surface;
  double exposure_s[2];
  for (int i = 0; i < 2; ++i) {
    CameraSimConfig config = small_config();
    config.scene.appearance.sun_elevation_rad = to_rad(i == 0 ? 15.0 : 60.0);
    StereoCameraSim camera(loccam_rig(), config, surface, 1);
    StereoCameraSim::Pair pair;
    for (int frame = 0; frame < 5; ++frame) pair = camera.render(body_at(surface, 0.0, 0.0), frame);
    EXPECT_NEAR(mean_grey(pair.left), config.imager.exposure_target, 3.0);
    exposure_s[i] = pair.exposure_s;
  }
  EXPECT_GT(exposure_s[0], 2.0 * exposure_s[1]);
}

// Mean absolute difference of neighbours, without noise.
double texture_of(const StereoCameraSim::Pair& pair) {
  double sum = 0.0;
  for (int v = 192; v < 384; ++v)
    for (int u = 1; u < 512; ++u) sum += std::abs(double{1} * pair.left.at(u, v) - pair.left.at(u - 1, v));
  return sum / (192 * 511);
}

TEST(StereoCameraSim, DustHasNoTexture) {
  const test::PlaneSurface surface;
  CameraSimConfig config = quiet_config();
  StereoCameraSim ground(loccam_rig(), config, surface, 1);
  config.scene.appearance.textureless_fraction = 1.0;
  StereoCameraSim dust(loccam_rig(), config, surface, 1);
  const Eigen::Isometry3d T_map_body = body_at(surface, 0.0, 0.0);
  const double textured = texture_of(ground.render(T_map_body, 0));
  EXPECT_GT(textured, 4.0);
  EXPECT_LT(texture_of(dust.render(T_map_body, 0)), 0.1 * textured);
}

TEST(GroundAppearance, DustCoversConfiguredFraction) {
  for (double fraction : {0.02, 0.05, 0.1, 0.3}) {
    GroundAppearanceConfig config;
    config.textureless_fraction = fraction;
    const GroundAppearance appearance(config);
    const float clear = appearance.at(0.0, 0.0, {Soil::kFirm, 3, 0.0}).fine_contrast > 0.1F ? 0.1F : 0.02F;
    int dusty = 0;
    constexpr int kSide = 400;
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        if (appearance.at(0.37 * i, 0.37 * j, {Soil::kFirm, -1, 0.0}).fine_contrast < clear) ++dusty;
    EXPECT_NEAR(dusty / double{kSide * kSide}, fraction, 0.35 * fraction) << fraction;
  }
}

TEST(TileScene, MemoryIsBoundedOnLongTraverse) {
  const test::PlaneSurface surface(0.0, 0.05, 0.02);
  TileSceneConfig config = test::small_scene();
  config.fine_radius_m = 1.0;
  config.middle_radius_m = 4.0;
  TileScene scene(surface, config);
  size_t peak_early = 0;
  size_t peak_late = 0;
  for (double x = 0.0; x <= 200.0; x += 2.0) {
    scene.focus(x, 0.3 * x);
    size_t& most = x < 60.0 ? peak_early : peak_late;
    most = std::max(most, scene.memory_bytes());
  }
  EXPECT_LT(peak_late, 1.2 * static_cast<double>(peak_early));
  EXPECT_LT(peak_late, 150e6);
}

}  // namespace
}  // namespace rover
