#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "made_up_campaign.hpp"
#include "tools/campaign/page/grids.hpp"
#include "tools/campaign/page/page_html.hpp"
#include "tools/campaign/page/page_table.hpp"
#include "tools/report/rasterise.hpp"

namespace rover::campaign {
namespace {

using testing::HasSubstr;
using testing::Not;

class Page : public testing::Test {
 protected:
  Page() : rows_(made_up_rows({.seeds = 20})) {
    for (Row& row : rows_) {
      // A corner of the page whose numbers are known.
      if (row.cell.at("level") != "full" || row.cell.at("rock_area") != "0.05" || row.cell.at("slope_deg") != "0")
        continue;
      row.figures["oracle_feasible"] = row.seed <= 2 ? 0.0 : 1.0;
      row.outcome = row.seed <= 17 ? "goal_reached" : "no_path";
    }
  }

  Panels panels() const {
    std::vector<Cell> cells;
    for (const auto& [cell, drives] : by_cell(pointers(rows_))) cells.push_back(cell);
    return panels_of(cells);
  }
  std::string html() const { return page_html(info_, panels(), pointers(rows_)); }
  std::string table() const { return page_table(info_, panels(), pointers(rows_), "campaign.png"); }

  std::vector<Row> rows_;
  PageInfo info_{"enav",
                 "0123456789ab",
                 "a machine, 2 cores",
                 "",
                 "./rover campaign config/campaigns/enav.yaml",
                 "./rover campaign page logs/campaigns/enav",
                 "scenario: <enav>\n",
                 [](const Row& row) { return "./rover run --seed " + std::to_string(row.seed); }};
};

TEST_F(Page, SaysThatDrivesAreMissing) {
  EXPECT_THAT(table(), Not(HasSubstr("not complete")));
  info_.part = "20 of 1800 drives";
  EXPECT_THAT(table(), HasSubstr("- not complete: 20 of 1800 drives\n"));
  EXPECT_THAT(html(), HasSubstr("20 of 1800 drives"));
}

TEST_F(Page, CellShowsSuccessNumberIntervalAndInfeasibleDrives) {
  // 15 of 18 feasible drives, 2 infeasible: Wilson's interval is 61 to 94 %.
  const std::string page = html();
  EXPECT_THAT(page, HasSubstr(">83 %</text>"));
  EXPECT_THAT(page, HasSubstr(">15/18</text>"));
  EXPECT_THAT(page, HasSubstr(">61–94</text>"));
  EXPECT_THAT(page, HasSubstr(">+2 inf.</text>"));
  EXPECT_THAT(table(), HasSubstr("| 15/18 (61–94 %), +2 inf. |"));
}

TEST_F(Page, TableOfOneCellListsItsDrivesInPlaceOfTheHeatMap) {
  std::erase_if(rows_, [&](const Row& row) { return row.cell != rows_.front().cell; });
  std::reverse(rows_.begin(), rows_.end());
  const std::string text = table();
  EXPECT_THAT(text, Not(HasSubstr("campaign.png")));
  EXPECT_LT(text.find("\n| 1 |"), text.find("\n| 20 |"));
}

TEST_F(Page, NoContactIsGoodAndOneContactIsAnAlarm) {
  EXPECT_THAT(html(), HasSubstr("badge good\">No contact"));
  for (Row& row : rows_)
    if (row.status == "done") {
      row.figures["collisions"] = 1.0;
      row.outcome = "collision";
      break;
    }
  EXPECT_THAT(html(), HasSubstr("badge bad\">1 contact<"));
  EXPECT_THAT(html(), HasSubstr(">1 contact</text>"));
  EXPECT_THAT(table(), HasSubstr("**1 contact**"));
}

TEST_F(Page, ContactOnAnInfeasibleMapIsShownBesideTheInfeasibleDrives) {
  for (Row& row : rows_)
    if (figure_of(row, "oracle_feasible") == 0.0 && row.cell.at("rock_area") == "0.05") {
      row.figures["collisions"] = 2.0;
      row.outcome = "collision";
      break;
    }
  EXPECT_THAT(html(), HasSubstr(">2 contacts</text>"));
  EXPECT_THAT(html(), HasSubstr(">+2 inf.</text>"));
}

TEST_F(Page, UnknownContactsAreNotNoContact) {
  rows_[0].figures.erase("collisions");
  EXPECT_THAT(html(), Not(HasSubstr("No contact")));
}

TEST_F(Page, FailuresHaveTheCommandOfTheirWorstDrives) {
  const std::string page = html();
  EXPECT_THAT(page, HasSubstr("<h3>no_path: "));
  EXPECT_THAT(page, HasSubstr("<h3>fault_stop: tilt_high: "));
  EXPECT_THAT(page, HasSubstr("<pre class=\"command\">./rover run --seed "));
  EXPECT_THAT(table(), HasSubstr("`./rover run --seed "));
}

TEST_F(Page, IsOneFileWithoutScript) {
  const std::string page = html();
  for (const char* outside : {"<script", "<link", "src=", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  EXPECT_THAT(page, HasSubstr("scenario: &lt;enav&gt;"));
}

TEST_F(Page, TellsCommitMachineAndCommand) {
  for (const char* part : {"0123456789ab", "a machine, 2 cores", "./rover campaign config/campaigns/enav.yaml"}) {
    EXPECT_THAT(html(), HasSubstr(part));
    EXPECT_THAT(table(), HasSubstr(part));
  }
}

TEST_F(Page, FiguresThatTheRowsLackAreNamed) {
  for (Row& row : rows_) row.figures.erase("regret");
  EXPECT_THAT(html(), HasSubstr("not in the rows"));
  EXPECT_THAT(table(), HasSubstr("n/a / n/a"));
}

TEST_F(Page, TablesHaveFurtherFiguresIfADriveHas) {
  for (Row& row : rows_) row.figures.erase("slam_odometry_ratio");
  EXPECT_THAT(table(), Not(HasSubstr("SLAM / odometry")));
  rows_.front().figures["slam_odometry_ratio"] = 1.25;
  EXPECT_THAT(table(), HasSubstr("SLAM / odometry error, median / worst"));
  EXPECT_THAT(table(), HasSubstr("| 1.25 / 1.25 |"));
}

TEST_F(Page, MarkdownTablesHaveAsManyCellsInEachLine) {
  info_.repeat = [](const Row&) { return std::string("./rover run --set 'a|b'"); };
  const std::string text = table();
  std::istringstream in(text);
  size_t columns = 0;
  for (std::string line; std::getline(in, line);) {
    size_t bars = 0;
    for (size_t i = 0; i < line.size(); ++i) bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\') ? 1 : 0;
    EXPECT_TRUE(bars == 0 || columns == 0 || bars == columns) << line;
    columns = bars;
  }
}

TEST_F(Page, HeatMapIsAPicture) {
  const std::string svg =
      sheet_svg("Success", "note", success_pictures(panels(), pointers(rows_)), {kSuccessColours, "0 %", "100 %"});
  const std::string file = testing::TempDir() + "campaign_heat_map.png";
  report::write_png(svg, 1.0, file);
  EXPECT_GT(std::filesystem::file_size(file), 20'000u);
  std::filesystem::remove(file);
}

TEST(Colours, AreTheStopsAtTheirPositionsAndTheMeanBetween) {
  const std::vector<ColourStop> scale = {{0.0, {0, 0, 0}}, {1.0, {100, 200, 50}}};
  EXPECT_EQ(colour_at(scale, 1.0).g, 200);
  EXPECT_EQ(colour_at(scale, 0.5).r, 50);
  EXPECT_EQ(colour_at(scale, -3.0).b, 0);
  EXPECT_EQ(colour_at(scale, 7.0).b, 50);
}

}  // namespace
}  // namespace rover::campaign
