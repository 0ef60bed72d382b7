// Detection rate of rocks by height and distance, with stereo-like noise.
#include <gtest/gtest.h>

#include <cstdio>

#include "test/hazard_detector/scene.hpp"

namespace rover::hazard {
namespace {

class DetectionRateTest : public SceneTest {
 protected:
  bool detected(const synthetic::World& world, double sigma_px) {
    const synthetic::Rock& rock = world.rocks.front();
    const HazardResult result = detect(world, sigma_px, 0.08);
    return map(result).count_near(is_hazard, rock.x_m, rock.y_m, 1.5 * rock.half_width_m + 0.15) > 0;
  }

  // Fraction of frames in which the rock is detected, over lateral positions, shapes, slopes and noise.
  double rate(double height_m, double x_m, const std::vector<double>& pitches_deg) {
    int frames = 0, hits = 0;
    for (double pitch_deg : pitches_deg)
      for (bool box : {false, true})
        for (double lateral_fraction : {-1.0, -0.3, 0.2, 0.8}) {
          synthetic::World world = sloped(pitch_deg);
          const double half_width_m = (frames + frames / 4) % 2 == 0 ? height_m : 0.5 * height_m;
          world.rocks.push_back({x_m, lateral_fraction * (0.30 + 0.35 * (x_m - 1.2)), half_width_m, height_m, box});
          hits += detected(world, 0.15 + 0.05 * (frames % 4));
          ++frames;
        }
    return static_cast<double>(hits) / frames;
  }
};

TEST_F(DetectionRateTest, DetectsTwentyCentimetreRocksInEveryFrameAndTenCentimetreRocksInNone) {
  std::printf("rate of frames with the rock reported; pitch 0, +-10 deg\nheight ");
  const std::vector<double> distances{1.2, 1.45, 1.7, 1.95, 2.2};
  for (double x : distances) std::printf(" %5.2f m", x);
  for (double height_m : {0.10, 0.15, 0.20, 0.30}) {
    std::printf("\n%4.2f m ", height_m);
    for (double x_m : distances) {
      const double detection_rate = rate(height_m, x_m, {0.0, -10.0, 10.0});
      std::printf(" %7.3f", detection_rate);
      EXPECT_GE(detection_rate, height_m >= 0.20 ? 0.95 : 0.0) << height_m << " m at " << x_m;
      EXPECT_LE(detection_rate, height_m <= 0.10 ? 0.0 : 1.0) << height_m << " m at " << x_m;
    }
  }
  std::printf("\n");
}

}  // namespace
}  // namespace rover::hazard
