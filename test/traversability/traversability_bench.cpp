// Time of a 200 x 200 map on one core, from heights to costs and difficulty; limit 30 ms.
#include <benchmark/benchmark.h>

#include "test/traversability/synthetic_terrain.hpp"
#include "traversability/difficulty.hpp"

namespace {

using namespace rover::trav;

void whole_map(benchmark::State& state) {
  testing_support::SyntheticMap spec;
  spec.noise_m = spec.sigma_m = 0.012;
  const TerrainGrid grid = testing_support::synthetic_terrain(
      [](double x, double y) {
        const double dx = x - 2.0 * std::round(0.5 * x), dy = y - 2.0 * std::round(0.5 * y);
        return 0.1 * x + 0.3 * std::sin(0.5 * y) + testing_support::block_m(dx, dy, 0.25, 0.2);
      },
      spec);
  for (auto _ : state) {
    const TraversabilityMap map = compute_traversability(grid, {});
    benchmark::DoNotOptimize(difficulty_ahead(map, {0.0, 0.0, 0.5}, {}));
  }
}

}  // namespace

BENCHMARK(whole_map)->Name("traversability/map_200x200")->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
