// Time of hazard detection without stereo matching, 512x384, one core; limit 2 ms.
#include <benchmark/benchmark.h>

#include <random>

#include "hazard_detector/hazard_detector.hpp"
#include "test/stereo/synthetic_world.hpp"

namespace {

void hazard_decision(benchmark::State& state) {
  const rover::StereoCamera camera = rover::synthetic::loccam_camera();
  rover::synthetic::World world;
  world.rocks = {{1.5, 0.2, 0.2, 0.2}, {2.2, -0.3, 0.2, 0.3, true}, {2.6, 0.4, 0.1, 0.1}};
  std::mt19937_64 random(1);
  const rover::Disparity disparity =
      rover::synthetic::noisy_disparity(rover::synthetic::exact_disparity(world, camera), camera, 0.2, 0.05, random);
  rover::hazard::HazardDetector detector({});
  for (auto _ : state) benchmark::DoNotOptimize(detector.step(disparity, camera));
}

}  // namespace

BENCHMARK(hazard_decision)->Name("hazard_detector/decision_512x384")->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
