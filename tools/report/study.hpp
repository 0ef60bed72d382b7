// Data of a report: run folder, log, terrain, metrics.
#pragma once

#include <optional>
#include <string>

#include "common/bus/log_runs.hpp"
#include "tools/report/html.hpp"
#include "tools/report/run_folder.hpp"
#include "tools/report/scene.hpp"

namespace rover::report {

struct Study {
  RunFolder folder;
  LogRun log;
  RunRecord run;
  std::optional<TrueWorld> world;
  HeightRaster orbital;
  RunEvaluation evaluation;
  Scene scene() const { return {run, evaluation, folder.footprint, orbital, world}; }
};

// Reads and evaluates the run; prints damage of the log on stderr. `log_run`: selects one of several runs. Throws
// ConfigError.
Study study_run(const std::string& run_dir, const std::string& default_config_dir, int log_run = 0);
// All pictures of the report. Reads the log again for camera images.
Pictures draw_pictures(const Study& study);

}  // namespace rover::report
