// What the pictures show.
#pragma once

#include <optional>

#include "common/geo/shaded_relief.hpp"
#include "tools/report/metrics.hpp"

namespace rover::report {

struct Scene {
  const RunRecord& run;
  const Judgement& judgement;
  const Footprint& footprint;
  const HeightRaster& orbital;  // empty: none in the run's folder
  const std::optional<TrueWorld>& world;
};

// Thinned to points at least step_m apart; the last one stays.
Points thinned(const Points& line, double step_m);
Points true_line(const Scene& scene);
// By the rover's own estimate, in map.
Points estimated_line(const Scene& scene);
// By the odometry alone, its start on the truth.
Points odometry_line(const Scene& scene);
Points planned_line(const Scene& scene);

}  // namespace rover::report
