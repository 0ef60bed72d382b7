// Time from a NavCam pair to its cloud on one core.
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

#include "test/point_cloud/navcam_world.hpp"

namespace {

using namespace rover;

void pair_to_cloud(benchmark::State& state) {
  cv::setNumThreads(1);
  synthetic::World world;
  world.rocks = {{2.5, 0.2, 0.25, 0.2}, {4.0, -0.6, 0.3, 0.3, true}};
  const double tilt_rad = to_rad(static_cast<double>(state.range(0)));
  const synthetic::RawPair pair = cloud::render_pair(world, 0.0, tilt_rad);
  cloud::PointCloud core({}, cloud::navcam_rig(), cloud::navcam_unit(), cloud::kGroundBelow);
  size_t points = core.step(pair.left, pair.right, 0.0, tilt_rad)->cloud.size();
  for (auto _ : state) benchmark::DoNotOptimize(core.step(pair.left, pair.right, 0.0, tilt_rad));
  state.counters["points"] = static_cast<double>(points);
}

}  // namespace

BENCHMARK(pair_to_cloud)->Name("point_cloud/pair_640x480_tilt_deg")->Arg(0)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
