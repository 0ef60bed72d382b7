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
      "Evaluates a run: metrics.json, report.html, traverse.svg and traverse.png in its folder. Two runs: compares "
      "them "
      "on one page.\n"
      "Examples: ./rover report logs/RUN       ./rover report logs/RUN_A logs/RUN_B");
  app.name("./rover report");
  app.add_option("run_dir", run_dirs, "run folder, or two of them")
      ->required()
      ->expected(1, 2)
      ->transform(rover::is_user_path());
  rover::repeatable(
      app.add_option("--log-run", log_runs, "number of the run in a log of several runs, from 1; one for each folder"))
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--out", out, "comparison page; default: compare-A-B.html in the current folder")
      ->transform(rover::is_user_path());
  app.add_option("--config", config_dir, "configuration of the vehicle, if the run folder has none")
      ->transform(rover::is_user_path())
      ->capture_default_str();
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  if (run_dirs.size() == 1 && !out.empty()) {
    std::fprintf(stderr,
                 "rover_report: --out is only for a comparison; the report of one run is written into its folder\n");
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
