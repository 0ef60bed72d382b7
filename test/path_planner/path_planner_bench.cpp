// What a frame and a plan cost, on random fields of rocks.
#include <benchmark/benchmark.h>

#include <ctime>

#include "test/path_planner/plan_scene.hpp"

namespace rover::planning::testing_support {
namespace {

constexpr std::uint64_t kBenchFields = 51;

void insert_frame(benchmark::State& state) {
  std::mt19937_64 random(3);
  const Pose2 pose{0.0, 0.0, 0.3};
  const HazardGrid frame = observe(CameraModel{}, random_rocks(3), pose, 0, random);
  BeliefMap belief{BeliefConfig{}};
  belief.move_to({0.0, 0.0});
  for (auto _ : state) belief.add(frame, from_planar(pose));
}
BENCHMARK(insert_frame)->Unit(benchmark::kMillisecond);

void make_costmap(benchmark::State& state) {
  const BeliefMap belief = certain_belief(ground_of(random_rocks(3)));
  for (auto _ : state) benchmark::DoNotOptimize(Costmap({}, belief, {}, 28.0));
}
BENCHMARK(make_costmap)->Unit(benchmark::kMillisecond);

void check_path(benchmark::State& state) {
  const BeliefMap belief = certain_belief(ground_of(random_rocks(3)));
  const PlanRequest request = plan_request(belief);
  const Costmap costmap({}, belief, {}, 14.0);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        find_blockage({.costmap = costmap, .route = *request.global_path, .footprint = search_config().footprint}));
}
BENCHMARK(check_path)->Unit(benchmark::kMillisecond);

double plan_s(const HybridPlanner& planner, const PlanRequest& request) {
  const std::clock_t begin = std::clock();
  benchmark::DoNotOptimize(planner.plan(request));
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// On the field with the median time.
void plan_median(benchmark::State& state) {
  const HybridPlanner planner(search_config());
  std::vector<std::pair<double, PlanRequest>> timed;
  for (std::uint64_t seed = 1; seed <= kBenchFields; ++seed) {
    const PlanRequest request = plan_request(certain_belief(ground_of(random_rocks(seed))));
    timed.emplace_back(plan_s(planner, request), request);
  }
  std::sort(timed.begin(), timed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const PlanRequest& median = timed[timed.size() / 2].second;
  for (auto _ : state) benchmark::DoNotOptimize(planner.plan(median));
  state.counters["worst_ms"] = 1e3 * timed.back().first;
}
BENCHMARK(plan_median)->Unit(benchmark::kMillisecond)->Iterations(20);

}  // namespace
}  // namespace rover::planning::testing_support

BENCHMARK_MAIN();
