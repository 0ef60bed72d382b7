// A run as the report sees it: its folder, its log, the ground, and what the judge says.
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
  Judgement judgement;
  Scene scene() const { return {run, judgement, folder.footprint, orbital, world}; }
};

// Reads and judges the run; what its log holds beside it, or not whole, is said on stderr. `log_run`: of a log that
// holds several runs; 0: the only one. Throws ConfigError.
Study study_run(const std::string& run_dir, const std::string& default_config_dir, int log_run = 0);
// All pictures of its report. The log is read again for those of the camera.
Pictures draw_pictures(const Study& study);

}  // namespace rover::report
