// Drives many rock fields in the simple world of rock_drive.hpp and prints the results: a tool for tuning.
//   traverse_study [first seed] [last seed] [k] [length m] [efficient | full] [keep-outs]
#include <cstdio>
#include <cstdlib>

#include "test/path_planner/rock_drive.hpp"

namespace rover::planning::testing_support {
namespace {

struct Tally {
  std::vector<double> ratios;
  int collided = 0;
  int replans = 0;
  int in_zones = 0;
};

void print(int seed, const DriveResult& r, double ratio, double duty) {
  std::printf(
      "seed %3d %s ratio %.3f replans %2d back-ups %d turns %d stops %2d (hazards %2d) stopped %5.1f s duty %.2f", seed,
      r.collided  ? "COLLISION"
      : r.reached ? "goal"
                  : "LOST",
      ratio, r.replans, r.back_ups, r.point_turns, r.stops, r.hazard_stops, r.stopped_s, duty);
  if (r.zone_depth_m > 0.0) std::printf(" IN A ZONE by %.2f m", r.zone_depth_m);
  std::printf(" clearance %.2f paths %d p99 %.3f s", r.min_clearance_m, r.paths, r.plan_p99_s);
  if (!r.reached) std::printf(" at %.2f %.2f: %s", r.track.back().x_m, r.track.back().y_m, r.text.c_str());
  std::printf("\n");
  std::fflush(stdout);
}

void study(int seed, double k, double length_m, bool full, int zones, Tally& tally) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::vector<Rock> rocks = rock_field(k, {-5.0, -15.0}, {length_m + 5.0, 15.0}, 0.2, random);
  const std::vector<Point2> path = {{0.0, 0.0}, {0.3 * length_m, 2.0}, {0.6 * length_m, -2.0}, {length_m, 0.0}};
  std::erase_if(rocks, [&](const Rock& r) { return distance(r.p, path.front()) < 2.0 + r.radius_m; });
  std::erase_if(rocks, [&](const Rock& r) { return distance(r.p, path.back()) < 3.0 + r.radius_m; });
  double planned_m = 0.0;
  for (size_t i = 1; i < path.size(); ++i) planned_m += distance(path[i - 1], path[i]);
  DriveConfig config;
  config.planner = planner_config();
  config.camera.false_hit_rate = 0.01;
  config.full = full;
  config.zones = random_zones(path, zones, static_cast<std::uint64_t>(seed));
  const DriveResult r = drive(config, rocks, path, static_cast<std::uint64_t>(seed));
  if (r.reached) tally.ratios.push_back(r.driven_m / planned_m);
  tally.collided += r.collided ? 1 : 0;
  tally.replans += r.replans;
  tally.in_zones += r.zone_depth_m > 0.0 ? 1 : 0;
  print(seed, r, r.driven_m / planned_m, r.driven_m / (config.speed_mps * r.duration_s));
}

}  // namespace
}  // namespace rover::planning::testing_support

int main(int argc, char** argv) {
  const int first = argc > 1 ? std::atoi(argv[1]) : 1;
  const int last = argc > 2 ? std::atoi(argv[2]) : 10;
  const double k = argc > 3 ? std::atof(argv[3]) : 0.08;
  const double length_m = argc > 4 ? std::atof(argv[4]) : 86.0;
  const bool full = argc > 5 && std::string(argv[5]) == "full";
  rover::planning::testing_support::Tally tally;
  const int zones = argc > 6 ? std::atoi(argv[6]) : 0;
  for (int seed = first; seed <= last; ++seed)
    rover::planning::testing_support::study(seed, k, length_m, full, zones, tally);
  std::sort(tally.ratios.begin(), tally.ratios.end());
  if (tally.ratios.empty()) return 1;
  std::printf("reached %zu of %d, collisions %d, in zones %d, ratio median %.3f worst %.3f, replans/m %.3f\n",
              tally.ratios.size(), last - first + 1, tally.collided, tally.in_zones,
              tally.ratios[tally.ratios.size() / 2], tally.ratios.back(),
              tally.replans / (length_m * (last - first + 1)));
  return 0;
}
