// How often a cell that the belief map calls a hazard with probability P is one, and how often cells change.
//   belief_study RUN_DIR... (runs of the simulator with their logs; from the project folder, whose config it takes)
#include <array>
#include <cstdio>
#include <rover/hazards_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/traversability_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/parameters.hpp"
#include "common/bus/streams.hpp"
#include "path_planner/config.hpp"
#include "path_planner/convert.hpp"
#include "path_planner/map/belief_map.hpp"
#include "tools/report/rock_evaluation.hpp"
#include "tools/report/study.hpp"
#include "tools/report/track.hpp"
#include "tools/report/true_relief.hpp"

namespace rover::planning {
namespace {

constexpr std::array kProbabilities = {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0};  // upper ends of the classes
constexpr std::array kRangesM = {2.0, 4.0, 8.0};
constexpr int kFramesPerLook = 5;  // 2 s

struct Class {
  int looks = 0;
  int hazards = 0;
  double sum_probability = 0.0;
  int places = 0;  // looks at one place are correlated: it is one trial
};

struct Tally {
  std::array<std::array<Class, kRangesM.size()>, kProbabilities.size()> classes{};
  int runs = 0;
  int cells = 0;
  int changes = 0;
  double map_cells[2] = {0.0, 0.0}, map_changes[2] = {0.0, 0.0};  // of HAZARDS, TRAVERSABILITY as they come
};

template <size_t N>
size_t class_of(double value, const std::array<double, N>& upper_ends) {
  const auto it = std::lower_bound(upper_ends.begin(), upper_ends.end() - 1, value);
  return static_cast<size_t>(it - upper_ends.begin());
}

// One run: the belief map as path_planner builds it, placed in the world by the true pose.
class Replay {
 public:
  Replay(const report::Study& study, const PathPlannerConfig& config, Tally& tally)
      : config_(config), belief_(config.belief), truth_(study.run.truth), relief_(*study.world), tally_(tally) {
    for_each_event(study.log, [this](const LogEvent& event) { take(event); });
    for (const auto& [map, i] : {std::pair(&study.evaluation.metrics.map.hazards, 0),
                                 std::pair(&study.evaluation.metrics.map.traversability, 1)})
      if (*map) {
        tally_.map_cells[i] += (*map)->observed_cells;
        tally_.map_changes[i] += (*map)->observed_cells * (*map)->changes_per_cell;
      }
    ++tally_.runs;
  }

 private:
  struct Place {
    std::uint32_t classes = 0;  // bit of each class in which it was counted
    bool seen = false;
    bool hazard = false;
  };

  void take(const LogEvent& event) {
    pose_t pose;
    hazards_t hazards;
    traversability_t traversability;
    if (event.channel == channel::kPose && decode_message(event.data, event.size, pose)) {
      history_.add(pose_from(pose, config_.origin_height_m));
      const Pose2 rover = planar(history_.newest().T_odom_ground);
      belief_.move_to(position(rover));
      belief_.mark_driven(rover, config_.footprint);
    }
    if (history_.empty()) return;
    if (event.channel == channel::kTraversability && decode_message(event.data, event.size, traversability))
      belief_.add(traversability_from(traversability), planar(history_.newest().T_odom_ground), config_.footprint);
    if (event.channel != channel::kHazards || !decode_message(event.data, event.size, hazards)) return;
    const HazardGrid grid = hazards_from(hazards);
    const auto T_odom_ground = history_.at(grid.utime);
    if (!T_odom_ground || !grid.fault().empty()) return;
    belief_.add(grid, *T_odom_ground);
    judge(history_.newest());
  }

  void judge(const PoseSample& now) {
    const auto T_true = truth_.known_at(to_seconds(now.utime));
    if (!T_true) return;
    const Pose2 rover = planar(now.T_odom_ground);
    const Pose2 T_map_odom = report::compose(planar(*T_true), report::inverse(rover));
    const Point2 camera = from_body(rover, config_.belief.view.camera);
    const bool look = frames_++ % kFramesPerLook == 0;
    belief_.cells().for_each([&](CellIndex i, const CellBelief& cell) {
      if (!cell.known || cell.driven) return;
      const Point2 p{belief_.cells().center_x_m(i), belief_.cells().center_y_m(i)};
      const double range_m = distance(p, camera);
      if (range_m >= kRangesM.back()) return;
      const double probability = belief_.probability(cell);
      Place& place = places_.at(i.ix, i.iy);
      const bool hazard = probability >= config_.costmap.hazard_probability;
      tally_.cells += place.seen ? 0 : 1;
      tally_.changes += place.seen && place.hazard != hazard ? 1 : 0;
      place.seen = true;
      place.hazard = hazard;
      if (look) count(report::transform(T_map_odom, {p.x_m, p.y_m}), range_m, probability, place);
    });
  }

  void count(const Eigen::Vector2d& p_map, double range_m, double probability, Place& place) {
    float rise_m = 0.0F;
    for (const double u : {-0.25, 0.25})
      for (const double v : {-0.25, 0.25})
        rise_m = std::max(rise_m, relief_.at(p_map + BeliefConfig::kCellM * Eigen::Vector2d(u, v)).rise_m);
    const size_t row = class_of(probability, kProbabilities);
    const size_t column = class_of(range_m, kRangesM);
    Class& c = tally_.classes[row][column];
    ++c.looks;
    c.hazards += rise_m >= report::kHazardRockM ? 1 : 0;
    c.sum_probability += probability;
    const std::uint32_t bit = 1U << (row * kRangesM.size() + column);
    c.places += (place.classes & bit) == 0 ? 1 : 0;
    place.classes |= bit;
  }

  const PathPlannerConfig& config_;
  BeliefMap belief_;
  PoseHistory history_;
  report::TrueTrack truth_;
  report::TrueRelief relief_;
  oracle::TiledGrid<Place> places_{BeliefConfig::kCellM};
  int frames_ = 0;
  Tally& tally_;
};

void print(const Tally& tally) {
  std::printf("%d runs. True fraction of hazards (95 %% interval) where the mean belief is P\n\n| P |", tally.runs);
  for (size_t r = 0; r < kRangesM.size(); ++r)
    std::printf(" %g to %g m: P | true | places |", r == 0 ? 0.0 : kRangesM[r - 1], kRangesM[r]);
  std::printf("\n|---|");
  for (size_t r = 0; r < 3 * kRangesM.size(); ++r) std::printf("---|");
  double from = 0.0;
  for (size_t row = 0; row < kProbabilities.size(); ++row) {
    std::printf("\n| %g to %g |", from, kProbabilities[row]);
    from = kProbabilities[row];
    for (const Class& c : tally.classes[row]) {
      if (c.looks == 0) {
        std::printf(" - | - | 0 |");
        continue;
      }
      const double ratio = static_cast<double>(c.hazards) / c.looks;
      const Interval bounds = wilson(ratio * c.places, c.places);
      std::printf(" %.3f | %.3f (%.3f to %.3f) | %d |", c.sum_probability / c.looks, ratio, bounds.low, bounds.high,
                  c.places);
    }
  }
  std::printf("\n\nChanges per cell between passable and hazard: %.3f",
              static_cast<double>(tally.changes) / tally.cells);
  for (const auto& [i, name] : {std::pair(0, "HAZARDS"), std::pair(1, "TRAVERSABILITY")})
    if (tally.map_cells[i] > 0.0)
      std::printf("; %s as it comes: %.3f", name, tally.map_changes[i] / tally.map_cells[i]);
  std::printf("\n");
}

}  // namespace
}  // namespace rover::planning

int main(int argc, char** argv) {
  using namespace rover;
  try {
    const planning::PathPlannerConfig config = planning::load_config("config");
    planning::Tally tally;
    for (int i = 1; i < argc; ++i) {
      const report::Study study = report::study_run(argv[i], "config");
      if (study.world && study.world->height_m && !study.run.truth.empty())
        planning::Replay(study, config, tally);
      else
        std::fprintf(stderr, "%s: no truth\n", argv[i]);
    }
    planning::print(tally);
  } catch (const ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
