// rover_report RUN_DIR: judges a run from its log.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <opencv2/core.hpp>

#include "report/make_report.hpp"

int main(int argc, char** argv) {
  std::string run_dir;
  std::string config_dir = "config";
  CLI::App app("Writes metrics.json, report.html, traverse.svg and traverse.png of a run");
  app.add_option("run_dir", run_dir, "the run's folder")->required();
  app.add_option("--config", config_dir, "vehicle of a run whose folder holds no configuration")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  cv::setNumThreads(1);
  try {
    std::printf("%s\n", rover::report::make_report(run_dir, config_dir).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rover_report: %s\n", error.what());
    return 2;
  }
  return 0;
}
