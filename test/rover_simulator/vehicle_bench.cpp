// Time of one physics step of 2 ms, and of one height of the world.
#include <benchmark/benchmark.h>

#include "rover_simulator/world/world.hpp"
#include "vehicle_fixture.hpp"
#include "world_fixture.hpp"

namespace rover {
namespace {

World make_world() {
  WorldConfig config;
  return World(config, plane_raster(200, 40, 1.0, 0.05, 0.3), 3);
}

void vehicle_tick(benchmark::State& state) {
  const World world = make_world();
  VehicleSim sim(test_vehicle(), {}, world, {10, 20, 0});
  for (auto _ : state) sim.advance(0.02, straight(0.15));
  state.SetLabel("10 steps of 2 ms");
}
BENCHMARK(vehicle_tick)->Unit(benchmark::kMicrosecond);

void world_height(benchmark::State& state) {
  const World world = make_world();
  double x = 10.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(world.height_m(x, 20.0));
    x = x < 190.0 ? x + 0.0237 : 10.0;
  }
}
BENCHMARK(world_height);

}  // namespace
}  // namespace rover

BENCHMARK_MAIN();
