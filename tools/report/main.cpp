// rover_report RUN_DIR: evaluates a run from its log. Two folders: compares the runs.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <opencv2/core.hpp>

#include "common/bus/command_line.hpp"
#include "tools/report/compare_runs.hpp"
#include "tools/report/make_report.hpp"

int main(int argc, char** argv) {
  std::vector<std::string> run_dirs;
  std::vector<int> log_runs;
  std::string config_dir = rover::project_dir() + "/config";
  std::string out;
  CLI::App app(
      "One run: makes its metrics.json, report.html, traverse.svg and traverse.png again. Two: compares them in one "
      "page.\n"
      "Examples: ./rover report logs/RUN       ./rover report logs/RUN_A logs/RUN_B");
  app.name("./rover report");
  app.add_option("run_dir", run_dirs, "the run's folder, or two")
      ->required()
      ->expected(1, 2)
      ->transform(rover::is_user_path());
  rover::repeatable(app.add_option("--log-run", log_runs,
                                   "of a log that holds several runs: the first is 1; of two folders one for each"))
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--out", out, "of a comparison; default: compare-A-B.html in the current folder")
      ->transform(rover::is_user_path());
  app.add_option("--config", config_dir, "vehicle of a run whose folder holds no configuration")
      ->transform(rover::is_user_path())
      ->capture_default_str();
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  if (run_dirs.size() == 1 && !out.empty()) {
    std::fprintf(stderr, "rover_report: --out is for a comparison; the report of one run goes into its folder\n");
    return 2;
  }
  log_runs.resize(run_dirs.size());
  cv::setNumThreads(1);
  try {
    using namespace rover::report;
    const std::string summary =
        run_dirs.size() == 1 ? make_report(run_dirs[0], config_dir, log_runs[0])
                             : compare_runs({run_dirs[0], log_runs[0]}, {run_dirs[1], log_runs[1]}, config_dir, out);
    std::printf("%s\n", summary.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rover_report: %s\n", error.what());
    return 2;
  }
  return 0;
}
