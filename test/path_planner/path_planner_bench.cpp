// Local repair on a 12 x 12 m map at 0.1 m among rocks (k = 8 %), as it happens on a drive: each frame that blocks the
// path starts one. The bound: 10 ms at the median on a 10 x 10 m map.
#include <benchmark/benchmark.h>

#include "rock_world.hpp"

namespace rover::planning::testing {
namespace {

struct Case {
  HazardMemory memory;
  Route route;
};

// Rover at the origin, everything within the camera's past and present view seen, the path straight ahead blocked.
Case blocked_case(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Rock> rocks = rock_field(0.08, {-6.0, -6.0}, {6.0, 6.0}, 0.3, random);
  std::erase_if(rocks, [](const Rock& r) { return std::abs(r.p.y_m) < 1.0 && r.p.x_m < 2.0; });
  rocks.push_back({{3.0, 0.1}, 0.25, 0.25});
  Case out{HazardMemory(HazardMemoryConfig{}), Route()};
  for (double x = -4.0; x <= 0.0; x += 0.08) {
    out.memory.move_to({x, 0.0});
    out.memory.mark_driven({x, 0.0, 0.0}, planner_config().footprint);
    out.memory.add(observe(CameraModel{}, rocks, {x, 0.0, 0.0}, 0, random), from_planar({x, 0.0, 0.0}), 0.0);
  }
  out.route = rounded({{{-4.0, 0.0}, kNaN, 0}, {{20.0, 0.0}, kNaN, 0}}, RoundingConfig{});
  return out;
}

void local_repair(benchmark::State& state) {
  std::vector<Case> cases;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) cases.push_back(blocked_case(seed));
  const PathPlannerConfig config = planner_config();
  const LocalRepair repair(config.repair);
  size_t next = 0;
  int found = 0;
  for (auto _ : state) {
    const Case& c = cases[next++ % cases.size()];
    const Terrain terrain(c.memory);
    const RepairResult result =
        repair.plan({terrain, c.route, 4.0, {0.02, 0.0, 0.0}, 0.0, {0.19, 0.0, 0.0}, 0.17, kInfinity, 0.5});
    found += result.status == RepairStatus::kFound ? 1 : 0;
  }
  state.counters["found_share"] = static_cast<double>(found) / static_cast<double>(state.iterations());
}
BENCHMARK(local_repair)->Unit(benchmark::kMillisecond)->Iterations(50);

void block_test(benchmark::State& state) {
  const Case c = blocked_case(3);
  const PathPlannerConfig config = planner_config();
  for (auto _ : state) {
    const Terrain terrain(c.memory);
    benchmark::DoNotOptimize(find_block({terrain, c.route, config.footprint, 4.0, {0.0, 0.0, 0.0}, 0.12}));
  }
}
BENCHMARK(block_test)->Unit(benchmark::kMillisecond);

void parts(benchmark::State& state) {
  const Case c = blocked_case(3);
  for (auto _ : state) {
    const Terrain terrain(c.memory);
    benchmark::DoNotOptimize(terrain.hazards().data());
  }
}
BENCHMARK(parts)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rover::planning::testing

BENCHMARK_MAIN();
