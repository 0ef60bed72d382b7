#include "tools/campaign/page/page_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <set>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"
#include "common/bus/user_files.hpp"
#include "tools/campaign/folder.hpp"
#include "tools/campaign/job.hpp"
#include "tools/campaign/page/comparison_page.hpp"
#include "tools/campaign/page/grids.hpp"
#include "tools/campaign/page/page_table.hpp"
#include "tools/campaign/store.hpp"
#include "tools/report/bench_rows.hpp"
#include "tools/report/rasterise.hpp"
#include "tools/report/run_folder.hpp"

namespace rover::campaign {
namespace fs = std::filesystem;
namespace {

std::string name_of(const std::string& dir) {
  return fs::weakly_canonical(dir).filename().string();
}

// Rows of one commit: drives of two programs are no campaign.
std::vector<Row> rows_of(const std::string& dir) {
  std::vector<Row> rows = Store::open(dir).rows(page_columns());
  if (rows.empty()) throw ConfigError(dir + ": no row yet; ./rover campaign --resume goes on with it");
  std::set<std::string> commits;
  for (const Row& row : rows) commits.insert(row.commit);
  if (commits.size() > 1)
    throw ConfigError(dir + ": rows of " + std::to_string(commits.size()) + " commits, as " + *commits.begin() +
                      " and " + *commits.rbegin() + "; a page shows one");
  return rows;
}

// As ./rover is called: relative, where the folder is in the project's.
std::string from_project(const std::string& dir) {
  const fs::path relative = fs::relative(dir, project_dir());
  return relative.empty() || *relative.begin() == ".." ? dir : relative.string();
}

std::function<std::string(const Row&)> repeat_of(const std::string& dir) {
  return [dir = from_project(dir), jobs = read_jobs(dir)](const Row& row) {
    const auto it = std::find_if(jobs.begin(), jobs.end(),
                                 [&](const Job& job) { return job.seed == row.seed && job.cell == row.cell; });
    return it == jobs.end() ? "not in jobs.jsonl" : repeat_command(dir, *it);
  };
}

PageInfo info_of(const PageArguments& arguments, const std::vector<Row>& rows) {
  constexpr size_t kMaxDefinition = 1'000'000;
  const report::BenchContext machine = report::this_machine();
  PageInfo info;
  info.name = name_of(arguments.dir);
  info.commit = rows.front().commit;
  info.machine = machine.cpu_model + ", " + std::to_string(machine.cores) + " cores";
  if (const size_t jobs = read_jobs(arguments.dir).size(); rows.size() < jobs)
    info.part = fmt::format("{} of {} drives", rows.size(), jobs);
  info.command = read_info(arguments.dir).command;
  info.page_command = arguments.command;
  info.definition = read_text(arguments.dir + "/campaign.yaml", kMaxDefinition);
  info.repeat = repeat_of(arguments.dir);
  return info;
}

// What an earlier command wrote is replaced, and no other file. `mark`: of the text in `file`, or in `beside` for a
// picture, which goes with that.
void require_own(const fs::path& file, const fs::path& beside, const std::string& mark) {
  if (!fs::exists(file)) return;
  if (!fs::is_regular_file(beside) || report::read_file(beside).find(mark) == std::string::npos)
    throw ConfigError(file.string() +
                      ": already exists and was not written by this command; choose another with --out");
}

void write(const fs::path& file, const std::string& text) {
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  write_file(file.string(), text);
  std::printf("%s\n", file.c_str());
}

// The file that an option names, with the endings that are to be written.
struct Output {
  fs::path base;
  bool html = true;
  bool table = true;
};

Output output_of(const std::string& out, const fs::path& standard) {
  if (out.empty()) return {standard};
  const fs::path file(out);
  const std::string ending = file.extension().string();
  if (ending != ".html" && ending != ".md") throw ConfigError(out + ": the name must end in .html or .md");
  return {fs::path(file).replace_extension(), ending == ".html", ending == ".md"};
}

fs::path with_ending(fs::path base, const char* ending) {
  return base += ending;
}

// `title`: how a page of this command begins.
void require_own(const Output& out, const std::string& title) {
  const fs::path page = with_ending(out.base, ".html"), table = with_ending(out.base, ".md");
  if (out.html) require_own(page, page, "<title>" + title + ": ");
  if (out.table) require_own(table, table, "# " + title + " `");
}

std::string heat_map(const PageInfo& info, const Panels& panels, const Drives& drives) {
  return sheet_svg(
      "Success of campaign " + info.name,
      "Feasible drives that reach their goal without contact, with the 95 % interval; inf.: infeasible for "
      "the oracle. Commit " +
          info.commit + (info.part.empty() ? "" : ". " + info.part),
      success_pictures(panels, drives), {kSuccessColours, "0 %", "100 %"});
}

}  // namespace

int page(const PageArguments& arguments) {
  const Output out = output_of(arguments.out, fs::path(arguments.dir) / "page");
  const fs::path picture = with_ending(out.base, ".png");
  require_own(out, "Campaign");
  if (out.table) require_own(picture, with_ending(out.base, ".md"), "](" + picture.filename().string() + ")");
  const std::vector<Row> rows = rows_of(arguments.dir);
  const PageInfo info = info_of(arguments, rows);
  const Drives drives = pointers(rows);
  std::vector<Cell> cells;
  for (const auto& [cell, of_cell] : by_cell(drives)) cells.push_back(cell);
  const Panels panels = panels_of(cells);
  if (out.html) write(with_ending(out.base, ".html"), page_html(info, panels, drives));
  if (out.table) {
    write(with_ending(out.base, ".md"), page_table(info, panels, drives, picture.filename().string()));
    if (cells.size() < 2) return 0;  // nothing to compare in a picture
    constexpr double kPixels = 1.5;  // per CSS pixel
    report::write_png(heat_map(info, panels, drives), kPixels, picture.string());
    std::printf("%s\n", picture.c_str());
  }
  return 0;
}

int compare_campaigns(const CompareArguments& arguments) {
  const std::string name_a = name_of(arguments.dir_a);
  const Output out = output_of(arguments.out, fs::path(arguments.dir_b) / ("compare_" + name_a));
  require_own(out, "Campaigns");
  const std::vector<Row> a = rows_of(arguments.dir_a);
  const std::vector<Row> b = rows_of(arguments.dir_b);
  const Comparison comparison = compare(a, b);
  if (comparison.pairs == 0)
    throw ConfigError(arguments.dir_a + " and " + arguments.dir_b + " have no cell and seed in common");
  const ComparisonInfo info{name_a, name_of(arguments.dir_b), a.front().commit, b.front().commit, arguments.command};
  if (out.html) write(with_ending(out.base, ".html"), comparison_html(info, comparison));
  if (out.table) write(with_ending(out.base, ".md"), comparison_table(info, comparison));
  return 0;
}

}  // namespace rover::campaign
