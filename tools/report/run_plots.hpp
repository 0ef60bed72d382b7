// The plots of a run.
#pragma once

#include <string>
#include <vector>

#include "tools/report/plot.hpp"
#include "tools/report/scene.hpp"

namespace rover::report {

std::vector<Plot> run_plots(const Scene& scene);
PlotMarks incident_marks(const Scene& scene);
// State over time as a coloured band.
std::string draw_state_timeline(const Scene& scene);

}  // namespace rover::report
