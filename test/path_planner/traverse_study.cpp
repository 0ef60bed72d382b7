// Drives many rock fields in the simple world of rock_world.hpp and prints what came of it: a tool for tuning.
//   traverse_study [first seed] [last seed] [k] [length m]
#include <cstdio>
#include <cstdlib>

#include "rock_world.hpp"

using namespace rover;
using namespace rover::planning;
using namespace rover::planning::testing;

int main(int argc, char** argv) {
  const int first = argc > 1 ? std::atoi(argv[1]) : 1;
  const int last = argc > 2 ? std::atoi(argv[2]) : 10;
  const double k = argc > 3 ? std::atof(argv[3]) : 0.08;
  const double length = argc > 4 ? std::atof(argv[4]) : 86.0;
  std::vector<double> ratios;
  int collided = 0;
  int reached = 0;
  int replans = 0;
  for (int seed = first; seed <= last; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::vector<Rock> rocks = rock_field(k, {-5.0, -15.0}, {length + 5.0, 15.0}, 0.2, random);
    const std::vector<Point2> path = {{0.0, 0.0}, {0.3 * length, 2.0}, {0.6 * length, -2.0}, {length, 0.0}};
    std::erase_if(rocks, [&](const Rock& r) { return distance(r.p, path.front()) < 2.0 + r.radius_m; });
    std::erase_if(rocks, [&](const Rock& r) { return distance(r.p, path.back()) < 3.0 + r.radius_m; });
    double planned = 0.0;
    for (size_t i = 1; i < path.size(); ++i) planned += distance(path[i - 1], path[i]);
    DriveConfig config;
    config.planner = planner_config();
    config.camera.false_hit_rate = 0.01;
    const DriveResult r = drive(config, rocks, path, static_cast<std::uint64_t>(seed));
    const double ratio = r.driven_m / planned;
    if (r.reached) ratios.push_back(ratio);
    collided += r.collided;
    reached += r.reached;
    replans += r.replans;
    std::printf("seed %3d %s ratio %.3f replans %2d turns %d stops %2d stopped %5.1f s duty %.2f clearance %.2f %s\n", seed,
                r.collided ? "COLLISION" : r.reached ? "goal" : "LOST", ratio, r.replans, r.point_turns, r.stops,
                r.stopped_s, r.driven_m / (0.2 * r.duration_s), r.least_clearance_m, r.reached ? "" : r.text.c_str());
    std::fflush(stdout);
    if (!r.reached)
      std::printf("    at %.2f %.2f yaw %.2f\n", r.track.back().x_m, r.track.back().y_m, r.track.back().yaw_rad);
  }
  std::sort(ratios.begin(), ratios.end());
  if (!ratios.empty())
    std::printf("reached %d of %d, collisions %d, ratio median %.3f worst %.3f, replans/m %.3f\n", reached,
                last - first + 1, collided, ratios[ratios.size() / 2], ratios.back(),
                replans / (length * (last - first + 1)));
  return 0;
}
