// Local repair on a 10 x 10 m map at 0.1 m among rocks with the path straight ahead blocked (the bound: 10 ms at the
// median), and the steps that every frame takes.
#include <benchmark/benchmark.h>

#include <ctime>

#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {
namespace {

constexpr std::uint64_t kFields = 51;
constexpr double kMarginM = 0.17;
constexpr double kSureWayM = 2.5;
constexpr double kGoalReachM = 0.3;

struct Scene {
  HazardMemory memory;
  Route route;
};

std::vector<Rock> blocking_rocks(std::mt19937_64& random) {
  std::vector<Rock> rocks = rock_field(0.08, {-5.0, -5.0}, {5.0, 5.0}, 0.3, random);
  std::erase_if(rocks, [](const Rock& r) { return std::abs(r.p.y_m) < 1.0 && r.p.x_m < 1.8; });
  rocks.push_back({{2.3, 0.1}, 0.25, 0.25});
  return rocks;
}

// The rover has come along the path to the origin and has seen what its camera passed.
Scene scene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::vector<Rock> rocks = blocking_rocks(random);
  HazardMemoryConfig config;
  config.cells = 100;
  Scene out{HazardMemory(config), rounded({{{-4.0, 0.0}, kNaN, 0}, {{20.0, 0.0}, kNaN, 0}}, RoundingConfig{})};
  for (double x = -4.0; x <= 0.0; x += 0.08) {
    const Pose2 pose{x, 0.0, 0.0};
    out.memory.move_to(position(pose));
    out.memory.mark_driven(pose, planner_config().footprint);
    out.memory.add(observe(CameraModel{}, rocks, pose, 0, random), from_planar(pose), 0.0);
  }
  return out;
}

RepairRequest request(const Terrain& terrain, const Route& route) {
  return {terrain, route, 4.0, {0.02, 0.0, 0.0}, 0.0, {0.19, 0.0, 0.0}, kMarginM, kSureWayM, kGoalReachM};
}

RepairStatus repair(const LocalRepair& planner, const Scene& s) {
  const Terrain terrain(s.memory);
  return planner.plan(request(terrain, s.route)).status;
}

struct Timing {
  double cpu_s = 0.0;
  size_t scene = 0;
};

std::vector<Timing> sorted_timings(const LocalRepair& planner, const std::vector<Scene>& scenes) {
  std::vector<Timing> timings;
  for (size_t i = 0; i < scenes.size(); ++i) {
    const std::clock_t begin = std::clock();
    repair(planner, scenes[i]);
    timings.push_back({static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, i});
  }
  std::sort(timings.begin(), timings.end(), [](const Timing& a, const Timing& b) { return a.cpu_s < b.cpu_s; });
  return timings;
}

// On the field whose repair takes the median time of all; those without a way take much longer than the rest.
void local_repair_median(benchmark::State& state) {
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; seed <= kFields; ++seed) scenes.push_back(scene(seed));
  const LocalRepair planner(planner_config().repair);
  const std::vector<Timing> timings = sorted_timings(planner, scenes);
  const Scene& median = scenes[timings[timings.size() / 2].scene];
  for (auto _ : state) benchmark::DoNotOptimize(repair(planner, median));
  const auto found = [&](const Scene& s) { return repair(planner, s) == RepairStatus::kFound; };
  state.counters["found_share"] =
      static_cast<double>(std::count_if(scenes.begin(), scenes.end(), found)) / static_cast<double>(kFields);
  state.counters["worst_ms"] = 1e3 * timings.back().cpu_s;
}
BENCHMARK(local_repair_median)->Unit(benchmark::kMillisecond)->Iterations(20);

void block_test(benchmark::State& state) {
  const Scene s = scene(3);
  const PathPlannerConfig config = planner_config();
  for (auto _ : state) {
    const Terrain terrain(s.memory);
    benchmark::DoNotOptimize(find_block({terrain, s.route, config.footprint, 4.0, {0.0, 0.0, 0.0}, config.margin_m}));
  }
}
BENCHMARK(block_test)->Unit(benchmark::kMillisecond);

void add_frame(benchmark::State& state) {
  Scene s = scene(3);
  std::mt19937_64 random(3);
  const Pose2 pose{0.0, 0.0, 0.3};
  const HazardGrid frame = observe(CameraModel{}, blocking_rocks(random), pose, 0, random);
  for (auto _ : state) s.memory.add(frame, from_planar(pose), 0.0);
}
BENCHMARK(add_frame)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rover::planning::testing_support

BENCHMARK_MAIN();
