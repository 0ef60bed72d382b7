// Time per 512 x 384 pair on one core (limit 25 ms): without a new keyframe, with a new keyframe, and averaged over a
// drive.
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

#include "synthetic_ground.hpp"

namespace rover::vo {
namespace {

constexpr int kPairs = 40;

std::vector<StereoFrame> make_drive() {
  cv::setNumThreads(1);
  SyntheticGround ground(1);
  std::vector<StereoFrame> frames;
  for (int i = 0; i < kPairs; ++i) {
    const Eigen::Isometry3d pose = SyntheticGround::over_ground(0.08 * i, 0.0, 0.01 * i);
    frames.push_back(ground.frame((i + 1) * 400'000, pose));
    frames.back().disparity = ground.ground_disparity(pose);
  }
  return frames;
}

const std::vector<StereoFrame>& drive() {
  static const std::vector<StereoFrame> frames = make_drive();
  return frames;
}

void DrivePerPair(benchmark::State& state) {
  drive();
  for (auto _ : state) {
    Odometry odometry(OdometryConfig{});
    for (const StereoFrame& frame : drive()) benchmark::DoNotOptimize(odometry.step(frame));
  }
  state.counters["per_pair"] =
      benchmark::Counter(kPairs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(DrivePerPair)->Unit(benchmark::kMillisecond);

// Registers the second pair with the first; with `replace` the second then becomes the new keyframe.
void second_pair(benchmark::State& state, bool replace) {
  OdometryConfig config;
  if (replace) config.keyframe_inliers = 100'000;
  for (auto _ : state) {
    state.PauseTiming();
    Odometry odometry(config);
    odometry.step(drive()[0]);
    state.ResumeTiming();
    benchmark::DoNotOptimize(odometry.step(drive()[1]));
  }
}
void PairWithinKeyframe(benchmark::State& state) {
  second_pair(state, false);
}
void PairThatBecomesKeyframe(benchmark::State& state) {
  second_pair(state, true);
}
BENCHMARK(PairWithinKeyframe)->Unit(benchmark::kMillisecond);
BENCHMARK(PairThatBecomesKeyframe)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rover::vo

BENCHMARK_MAIN();
