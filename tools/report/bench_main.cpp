// rover_bench_table: makes the result table of a benchmark from its rows.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "common/bus/command_line.hpp"
#include "common/bus/config.hpp"
#include "tools/report/bench_rows.hpp"
#include "tools/report/run_folder.hpp"

int main(int argc, char** argv) {
  rover::report::BenchContext context = rover::report::this_machine();
  std::vector<std::string> rows_files;
  std::string out_file;
  CLI::App app("Writes the table of a bench from one metrics.json a line");
  app.add_option("--suite", context.suite, "name of the bench")->required();
  app.add_option("--rows", rows_files, "rows.jsonl, one or more")->required();
  app.add_option("--out", out_file, "the Markdown file to write")->required();
  app.add_option("--command", context.command, "the command that made the rows");
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  if (context.command.empty()) context.command = "./rover bench " + context.suite;
  try {
    using namespace rover::report;
    const BenchSuite* suite = find_suite(context.suite);
    if (suite == nullptr)
      throw rover::ConfigError("--suite: '" + context.suite + "' has no table; known: seed, default");
    std::vector<BenchRow> rows;
    for (const std::string& file : rows_files)
      for (const BenchRow& row : parse_rows(read_file(file), file)) rows.push_back(row);
    rows = newest_rows(rows);
    const std::filesystem::path folder = std::filesystem::path(out_file).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder);
    write_file(out_file, suite->table(context, rows));
    for (const Gate& gate : suite->gates(rows))
      std::printf("%-7s %s: %s\n", gate.met ? "met" : "NOT MET", gate.requirement.c_str(), gate.measured.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rover_bench_table: %s\n", error.what());
    return 2;
  }
  return 0;
}
