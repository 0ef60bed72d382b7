// Time of rectification and disparity at 512x384 on one core; limit 20 ms.
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

#include "common/stereo/stereo.hpp"
#include "test/stereo/synthetic_world.hpp"

namespace {

void rectification_and_disparity(benchmark::State& state) {
  cv::setNumThreads(1);
  const rover::StereoRig rig = rover::synthetic::loccam_rig();
  rover::synthetic::World world;
  world.rocks = {{1.5, 0.2, 0.25, 0.2}, {2.0, -0.3, 0.3, 0.3, true}};
  const rover::synthetic::RawPair pair = rover::synthetic::render(world, rig, 1.0, 5);
  rover::stereo::Stereo stereo({}, rig, 0.62);
  for (auto _ : state) benchmark::DoNotOptimize(stereo.step(pair.left, pair.right));
}

}  // namespace

BENCHMARK(rectification_and_disparity)
    ->Name("stereo/rectification_and_disparity_512x384")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
