#include "tools/report/make_report.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "common/bus/config.hpp"
#include "tools/report/html_parts.hpp"
#include "tools/report/metrics_json.hpp"
#include "tools/report/no_truth.hpp"
#include "tools/report/rasterise.hpp"

namespace rover::report {
namespace {

// Overwrites only the files of an earlier report.
void check_targets(const std::string& dir) {
  namespace fs = std::filesystem;
  const std::string metrics = dir + "/metrics.json";
  const bool made_before =
      fs::is_regular_file(metrics) && read_file(metrics).find("\"path_ratio\"") != std::string::npos;
  for (const char* name :
       {"metrics.json", "traverse.svg", "traverse.png", "elevation.png", "levels.png", "report.html"}) {
    const fs::path file = fs::path(dir) / name;
    if (fs::is_symlink(file) || (fs::exists(file) && !made_before))
      throw ConfigError(file.string() + ": already exists and is not part of a report; move it away");
  }
}

}  // namespace

std::string write_report(const Study& study) {
  constexpr double kPngScale = 1.0;
  const RunFolder& folder = study.folder;
  const Metrics& m = study.evaluation.metrics;
  write_file(folder.dir + "/metrics.json",
             metrics_json(m).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  const Pictures pictures = draw_pictures(study);
  write_file(folder.dir + "/traverse.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + pictures.map);
  write_png(pictures.map, kPngScale, folder.dir + "/traverse.png");
  if (!pictures.elevation.empty()) write_png(pictures.elevation, kPngScale, folder.dir + "/elevation.png");
  if (!pictures.levels.empty()) write_png(pictures.levels, kPngScale, folder.dir + "/levels.png");
  write_file(folder.dir + "/report.html", report_html(study.scene(), pictures, configuration_texts(folder)));
  return fmt::format("{}: {}, {:.1f} m driven of {} planned, {} repairs, {}", folder.dir, m.outcome, m.driven_length_m,
                     shown(m.planned_length_m, 1, "m"), m.replans,
                     has_truth(m) ? fmt::format("{} collisions", m.collisions) : "no ground truth");
}

std::string make_report(const std::string& run_dir, const std::string& default_config_dir, int log_run) {
  check_targets(run_dir);
  return write_report(study_run(run_dir, default_config_dir, log_run));
}

}  // namespace rover::report
