#include "tools/campaign/page/page_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "made_up_campaign.hpp"
#include "tools/campaign/page/results.hpp"
#include "tools/campaign/store.hpp"
#include "tools/report/run_folder.hpp"

namespace rover::campaign {
namespace fs = std::filesystem;
namespace {

using testing::HasSubstr;

class PageCommand : public testing::Test {
 protected:
  PageCommand() : root_(testing::TempDir() + "page_command_test") {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~PageCommand() override { fs::remove_all(root_); }

  std::string folder(const std::string& name, const std::vector<Row>& rows) const {
    const std::string dir = root_ + "/" + name;
    fs::create_directories(dir);
    write_jobs(dir, made_up_jobs(rows));
    std::ofstream(dir + "/campaign.yaml") << "scenario: enav\n";
    std::ofstream(dir + "/campaign.json")
        << R"({"name": "enav", "commit": "0123456789ab", "command": "./rover campaign enav.yaml", "drive_program": ""})";
    Store::create(dir).add(rows);
    return dir;
  }

  static std::string refusal(const PageArguments& arguments) {
    try {
      page(arguments);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string root_;
};

TEST_F(PageCommand, WritesPageTableAndPicture) {
  const std::string dir = folder("first", made_up_rows({.seeds = 3}));
  EXPECT_EQ(page({dir, "", "./rover campaign first.yaml"}), 0);
  EXPECT_THAT(report::read_file(dir + "/page.html"), HasSubstr("Campaign: first"));
  EXPECT_THAT(report::read_file(dir + "/page.html"),
              HasSubstr("--level efficient --perception geometric --record full"));
  EXPECT_THAT(report::read_file(dir + "/page.md"), HasSubstr("](page.png)"));
  EXPECT_TRUE(fs::exists(dir + "/page.png"));
}

TEST_F(PageCommand, CommandsNameAFolderOfTheProjectRelativeToIt) {
  const fs::path dir = fs::canonical("/proc/self/exe").parent_path() / "page_command_test";
  fs::remove_all(dir);
  fs::copy(folder("first", made_up_rows({.seeds = 1})), dir, fs::copy_options::recursive);
  page({dir.string(), root_ + "/page.html", ""});
  fs::remove_all(dir);
  EXPECT_THAT(report::read_file(root_ + "/page.html"),
              HasSubstr("./rover run " + fs::relative(dir, project_dir()).string() + "/scenarios/"));
}

// 100,000 rows of 60 figures and those of the page, in 72 cells.
TEST_F(PageCommand, ManyRowsAreReadInSeconds) {
  const std::string dir = folder("many", {});
  Store store = Store::create(dir);
  std::vector<Row> rows;
  for (int i = 0; i < 100'000; ++i) {
    rows.push_back({"c", {{"rock_area", std::to_string(i % 72)}}, i / 72, 1, "done", "goal_reached", {}, {}});
    for (int k = 0; k < 60; ++k) rows.back().figures["figure_" + std::to_string(k)] = i + k;
    for (const ShownFigure& figure : kShownFigures) rows.back().figures[figure.key] = i;
    if (rows.size() == 2000) {
      store.add(rows);
      rows.clear();
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Row> read = Store::open(dir).rows(page_columns());
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("100,000 rows for a page: %.2f s\n", took_s);
  EXPECT_EQ(read.size(), 100'000U);
  EXPECT_EQ(read.back().figures.size(), std::size(kShownFigures));
  EXPECT_LT(took_s, 10.0);
}

TEST_F(PageCommand, EndingOfTheOutputSaysWhatIsWritten) {
  const std::string dir = folder("first", made_up_rows({.seeds = 2}));
  page({dir, root_ + "/results/campaign.md", ""});
  EXPECT_TRUE(fs::exists(root_ + "/results/campaign.md"));
  EXPECT_TRUE(fs::exists(root_ + "/results/campaign.png"));
  EXPECT_FALSE(fs::exists(root_ + "/results/campaign.html"));
  page({dir, root_ + "/alone.html", ""});
  EXPECT_TRUE(fs::exists(root_ + "/alone.html"));
  EXPECT_FALSE(fs::exists(root_ + "/alone.md"));
  EXPECT_EQ(refusal({dir, root_ + "/page.pdf", ""}), root_ + "/page.pdf: the name must end in .html or .md");
}

TEST_F(PageCommand, ReplacesItsOwnFilesAlone) {
  const std::string dir = folder("first", made_up_rows({.seeds = 2}));
  const std::string name = root_ + "/notes";
  const auto both = [&] { return refusal({dir, name + ".html", ""}) + refusal({dir, name + ".md", ""}); };
  EXPECT_EQ(both() + both(), "acceptedacceptedacceptedaccepted");
  for (const char* ending : {".html", ".md", ".png"}) {
    fs::remove(name + ".md");
    std::ofstream(name + ending) << "mine";
    EXPECT_THAT(both(), HasSubstr("notes" + std::string(ending) + ": already exists and was not written by this"));
    EXPECT_EQ(report::read_file(name + ending), "mine");
    fs::remove(name + ending);
  }
  std::ofstream(name + ".md") << "mine";
  EXPECT_THROW(compare_campaigns({dir, dir, name + ".md", ""}), ConfigError);
}

TEST_F(PageCommand, RefusesFoldersWithoutRowsAndRowsOfTwoCommits) {
  EXPECT_THAT(refusal({root_ + "/none", "", ""}), HasSubstr("none"));
  EXPECT_THAT(refusal({folder("empty", {}), "", ""}), HasSubstr("empty: no row yet"));
  std::vector<Row> rows = made_up_rows({.seeds = 1});
  rows[0].commit = "another";
  EXPECT_THAT(refusal({folder("mixed", rows), "", ""}), HasSubstr("mixed: rows of 2 commits"));
}

TEST_F(PageCommand, ComparesTwoFolders) {
  const std::string a = folder("first", made_up_rows({.seeds = 6}));
  const std::string b = folder("second", made_up_rows({.seeds = 6, .improvement = 0.5}));
  EXPECT_EQ(compare_campaigns({a, b, "", "./rover campaign compare first second"}), 0);
  EXPECT_THAT(report::read_file(b + "/compare_first.html"), HasSubstr("Campaigns: first and second"));
  EXPECT_THAT(report::read_file(b + "/compare_first.md"), HasSubstr("./rover campaign compare first second"));
}

TEST_F(PageCommand, RefusesCampaignsWithoutACommonDrive) {
  const std::vector<Row> rows = made_up_rows({.seeds = 2});
  std::vector<Row> others = rows;
  for (Row& row : others) row.seed += 100;
  EXPECT_THROW(compare_campaigns({folder("first", rows), folder("second", others), "", ""}), ConfigError);
}

}  // namespace
}  // namespace rover::campaign
