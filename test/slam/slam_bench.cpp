// Time of one map update (20 x 20 m at 0.1 m, 20,000 points; gate 30 ms) and of one filter update (gate 60 ms), one
// core.
#include <benchmark/benchmark.h>

#include "slam/slam.hpp"
#include "test/slam/navcam.hpp"

namespace {

using namespace rover;
using namespace rover::slam;
using namespace rover::slam::testing_support;

// About 20,000 points.
std::vector<Cloud> clouds() {
  std::vector<Cloud> all;
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    Cloud cloud = cloud_of(Ground{}, upright({0.5 * i, 0, 0}, kOriginHeightM), NavcamModel{.step_px = 3}, random,
                           to_utime(2.5 * (i + 1)));
    while (cloud.points.size() > 20'000)
      cloud.points.erase(cloud.points.begin() +
                         static_cast<std::ptrdiff_t>(random.unit() * static_cast<double>(cloud.points.size())));
    all.push_back(cloud);
  }
  return all;
}

void map_update(benchmark::State& state) {
  const std::vector<Cloud> views = clouds();
  ElevationMap map({});
  size_t i = 0;
  for (auto _ : state) {
    const double x = 0.5 * static_cast<double>(i % views.size());
    map.move_to(x, 0);
    map.insert(align_to_gravity(views[i % views.size()], upright({x, 0, 0}, kOriginHeightM), {}),
               {{x, 0, 0}, kOriginHeightM, x});
    ++i;
  }
  state.counters["points"] = static_cast<double>(views[0].points.size());
}

// Prediction, matching of all particles, resampling, and the map update.
void filter_update(benchmark::State& state) {
  const std::vector<Cloud> views = clouds();
  SlamConfig config;
  config.filter.min_particles = config.filter.max_particles;
  Slam slam(config);
  size_t i = 0;
  for (auto _ : state) {
    Cloud cloud = views[i % views.size()];
    cloud.utime = to_utime(2.5 * static_cast<double>(i + 1));
    const double x = 0.5 * static_cast<double>(i % views.size());
    if (i % views.size() == 0) {
      state.PauseTiming();
      slam = Slam(config);
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(slam.step(cloud, {upright({x, 0, 0}, kOriginHeightM), 0.0, 0.0}));
    ++i;
  }
}

void elevation_message(benchmark::State& state) {
  Slam slam({});
  slam.step(clouds()[0], {upright({}, kOriginHeightM), 0.0, 0.0});
  for (auto _ : state) benchmark::DoNotOptimize(slam.elevation());
}

}  // namespace

BENCHMARK(map_update)->Name("slam/map_update_20000_points")->Unit(benchmark::kMillisecond);
BENCHMARK(filter_update)->Name("slam/filter_and_map_update_400_particles")->Unit(benchmark::kMillisecond);
BENCHMARK(elevation_message)->Name("slam/elevation_in_odom")->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
