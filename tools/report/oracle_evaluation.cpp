#include "tools/report/oracle_evaluation.hpp"

#include "tools/oracle/oracle.hpp"

namespace rover::report {

void evaluate_oracle(const RunRecord& run, const Vehicle& vehicle, const std::optional<TrueWorld>& world,
                     RunEvaluation& evaluation) {
  const TrueTrack truth(run.truth);
  Metrics& m = evaluation.metrics;
  if (truth.empty() || m.paths.size() != 1 || m.paths.front().points.empty()) return;
  if (!world || !world->height_m || !world->ground_m) return;
  constexpr double kPointsM = 0.1;
  const PathRecord& planned = m.paths.front();
  // A zone drawn over the start when the rover had left it.
  if (forbidding_zone(planned.zones, planned.points.front()) != nullptr) return;
  const oracle::Result found =
      oracle::shortest_path({.height_m = world->height_m,
                             .ground_m = world->ground_m,
                             .map_width_m = world->width_m,
                             .map_length_m = world->length_m,
                             .vehicle = vehicle,
                             .start = planar(ground_pose(truth.at(m.window.begin_s), vehicle.origin_height_m)),
                             .planned = planned.points,
                             .goal_tolerance_m = world->goal_tolerance_m,
                             .corridor_half_width_m = world->corridor_half_width_m,
                             .zones = planned.zones});
  if (found.status != oracle::Status::kGaveUp) m.oracle_feasible = found.status == oracle::Status::kFound;
  m.oracle_m = found.length_m;
  evaluation.oracle_path = oracle::points_of(found.path, kPointsM);
  if (m.outcome == "goal_reached" && m.oracle_m > 0.0) m.regret = m.driven_length_m / m.oracle_m;
}

}  // namespace rover::report
