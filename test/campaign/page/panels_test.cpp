#include "tools/campaign/page/panels.hpp"

#include <gtest/gtest.h>

#include "made_up_campaign.hpp"

namespace rover::campaign {
namespace {

std::vector<Cell> product(const std::vector<CellAxis>& axes) {
  std::vector<Cell> cells = {{}};
  for (const CellAxis& axis : axes) {
    std::vector<Cell> longer;
    for (const Cell& cell : cells)
      for (const std::string& value : axis.values) {
        longer.push_back(cell);
        longer.back()[axis.name] = value;
      }
    cells = longer;
  }
  return cells;
}

TEST(Panels, RockAreaAndSlopeAreTheAxesAndTheOthersMakePanels) {
  std::vector<Cell> cells;
  for (const Row& row : made_up_rows({.seeds = 1})) cells.push_back(row.cell);
  const Panels panels = panels_of(cells);
  EXPECT_EQ(panels.x.name, "rock_area");
  EXPECT_EQ(panels.x.values, (std::vector<std::string>{"0.05", "0.07", "0.1", "0.12", "0.15", "0.2"}));
  EXPECT_EQ(panels.y.name, "slope_deg");
  EXPECT_EQ(panels.common, (Cell{{"scenario", "enav"}, {"perception", "geometric"}}));
  std::vector<std::string> titles;
  for (const Panel& panel : panels.panels) titles.push_back(panel_title(panel));
  EXPECT_EQ(titles, (std::vector<std::string>{"Efficient level, downhill", "Efficient level, across the slope",
                                              "Efficient level, uphill", "Full level, downhill",
                                              "Full level, across the slope", "Full level, uphill"}));
}

TEST(Panels, FlatCellsAreInThePanelOfEachDirection) {
  std::vector<Cell> cells =
      product({{"rock_area", {"0.05", "0.1"}}, {"slope_deg", {"5"}}, {"slope_direction", {"down", "up"}}});
  cells.push_back({{"rock_area", "0.05"}, {"slope_deg", "0"}, {"slope_direction", "flat"}});
  const Panels panels = panels_of(cells);
  ASSERT_EQ(panels.panels.size(), 2u);
  EXPECT_TRUE(repeats_flat_cells(panels));
  for (const Panel& panel : panels.panels) {
    EXPECT_EQ(panel.cells[0], cells.back()) << panel_title(panel);
    EXPECT_FALSE(panel.cells[1].has_value());  // rock area 0.1 on flat ground
    EXPECT_TRUE(panel.cells[2].has_value());
  }
}

TEST(Panels, FlatGroundAloneIsAPanel) {
  const Panels panels =
      panels_of({{{"rock_area", "0.05"}, {"slope_deg", "0"}, {"slope_direction", "flat"}, {"level", "full"}},
                 {{"rock_area", "0.05"}, {"slope_deg", "5"}, {"slope_direction", "up"}, {"level", "efficient"}}});
  size_t drawn = 0;
  for (const Panel& panel : panels.panels)
    for (const auto& cell : panel.cells) drawn += cell ? 1 : 0;
  EXPECT_EQ(drawn, 2u);
}

TEST(Panels, OtherwiseTheAxesWithMostValues) {
  const Panels panels = panels_of(product({{"level", {"full", "efficient"}},
                                           {"path_planner.search.horizon_m", {"4", "8", "12", "16"}},
                                           {"sun_elevation_deg", {"10", "40", "70"}}}));
  EXPECT_EQ(panels.x.name, "path_planner.search.horizon_m");
  EXPECT_EQ(panels.x.values, (std::vector<std::string>{"4", "8", "12", "16"}));  // by number
  EXPECT_EQ(panels.y.name, "sun_elevation_deg");
  EXPECT_EQ(panels.panels.size(), 2u);
}

TEST(Panels, OneAxisOrNone) {
  const Panels one = panels_of(product({{"soil", {"sand", "firm"}}}));
  EXPECT_EQ(one.x.name, "soil");
  EXPECT_EQ(one.y.name, "");
  EXPECT_FALSE(repeats_flat_cells(one));
  ASSERT_EQ(one.panels.size(), 1u);
  EXPECT_EQ(one.panels[0].cells.size(), 2u);
  const Panels none = panels_of({{{"scenario", "flat"}}});
  ASSERT_EQ(none.panels.size(), 1u);
  EXPECT_EQ(none.panels[0].cells, (std::vector<std::optional<Cell>>{Cell{{"scenario", "flat"}}}));
}

TEST(Panels, AxisOfOneBlockAloneIsDefaultInTheOthers) {
  const Panels panels = panels_of({{{"soil", "sand"}}, {{"soil", "sand"}, {"path_planner.a", "3"}}});
  EXPECT_EQ(panels.x.name, "path_planner.a");
  EXPECT_EQ(panels.x.values, (std::vector<std::string>{"3", "default"}));
}

TEST(Panels, Titles) {
  EXPECT_EQ(axis_title("rock_area"), "rock area [%]");
  EXPECT_EQ(axis_title("sun_elevation_deg"), "sun elevation [deg]");
  EXPECT_EQ(axis_title("slam.window_m"), "window_m");
  EXPECT_EQ(value_title("slam.window_m", "3"), "slam.window_m 3");
  EXPECT_EQ(value_title("rock_area", "0.07"), "rock area 7 %");
  EXPECT_EQ(cell_title({{"level", "full"}, {"slope_deg", "10"}, {"slope_direction", "up"}}, {{"level", "full"}}),
            "slope 10 deg, uphill");
}

}  // namespace
}  // namespace rover::campaign
