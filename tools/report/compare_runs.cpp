#include "tools/report/compare_runs.hpp"

#include <filesystem>

#include "common/bus/config.hpp"
#include "tools/report/compare_html.hpp"
#include "tools/report/study.hpp"

namespace rover::report {
namespace {

namespace fs = std::filesystem;

std::string name_of(const std::string& dir) {
  const fs::path whole = fs::absolute(dir).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

// Overwrites an earlier comparison page, and no other file.
void check_target(const std::string& file) {
  if (!fs::exists(file)) return;
  if (!fs::is_regular_file(file) || read_file(file).find("<title>Compared: ") == std::string::npos)
    throw ConfigError(file + ": already exists and is not a comparison page; choose another file with --out");
}

ComparedRun compared(const std::string& name, const Study& study) {
  return {name, study.evaluation.metrics, draw_pictures(study)};
}

}  // namespace

std::string compare_runs(const RunToCompare& run_a, const RunToCompare& run_b, const std::string& default_config_dir,
                         const std::string& out) {
  const std::string name_a = name_of(run_a.dir);
  const std::string name_b = name_of(run_b.dir);
  const std::string file = out.empty() ? "compare-" + name_a + "-" + name_b + ".html" : out;
  check_target(file);
  const Study a = study_run(run_a.dir, default_config_dir, run_a.log_run);
  const Study b = study_run(run_b.dir, default_config_dir, run_b.log_run);
  const auto differences = config_differences(configuration_texts(a.folder), configuration_texts(b.folder));
  write_file(file, compare_html(compared(name_a, a), compared(name_b, b), differences));
  return file + ": " + name_a + " beside " + name_b;
}

}  // namespace rover::report
