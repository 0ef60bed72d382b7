// Input of the pictures.
#pragma once

#include <optional>

#include "common/geo/shaded_relief.hpp"
#include "tools/report/metrics.hpp"

namespace rover::report {

struct Scene {
  const RunRecord& run;
  const RunEvaluation& evaluation;
  const Footprint& footprint;
  const HeightRaster& orbital;  // empty: not in the run folder
  const std::optional<TrueWorld>& world;
};

// Decimates to points at least step_m apart; keeps the last one.
Points thinned(const Points& line, double step_m);
Points true_line(const Scene& scene);
// Estimated track, in map.
Points estimated_line(const Scene& scene);
// Odometry track, aligned with the truth at the start.
Points odometry_line(const Scene& scene);
Points planned_line(const Scene& scene);

}  // namespace rover::report
