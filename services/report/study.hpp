// A run as the report sees it: its folder, its log, the ground, and what the judge says.
#pragma once

#include <optional>
#include <string>

#include "report/html.hpp"
#include "report/run_folder.hpp"
#include "report/scene.hpp"

namespace rover::report {

struct Study {
  RunFolder folder;
  RunRecord run;
  std::optional<TrueWorld> world;
  HeightRaster orbital;
  Judgement judgement;
  Scene scene() const { return {run, judgement, folder.footprint, orbital, world}; }
};

// Reads and judges the run. Throws ConfigError.
Study study_run(const std::string& run_dir, const std::string& default_config_dir);
// All pictures of its report. The log is read again for those of the camera.
Pictures draw_pictures(const Study& study);

}  // namespace rover::report
