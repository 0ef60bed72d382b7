// The cells of a campaign as panels: two axes across and up, one panel for each combination of the others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/row.hpp"

namespace rover::campaign {

struct CellAxis {
  std::string name;  // empty: the campaign has none
  std::vector<std::string> values;
};

struct Panel {
  Cell fixed;                              // axes that are neither x nor y
  std::vector<std::optional<Cell>> cells;  // by y, then x; none: not driven
};

struct Panels {
  CellAxis x;
  CellAxis y;
  std::vector<Panel> panels;
  Cell common;  // axes with the same value in every cell
};

// x and y are rock area and slope if both vary, else the two axes with most values. Flat cells have no direction of the
// slope: they are in the panel of each.
Panels panels_of(const std::vector<Cell>& cells);

// True if flat cells are in more than one panel.
bool repeats_flat_cells(const Panels& panels);

// "rock area [%]", for the edge of a panel.
std::string axis_title(const std::string& axis);
// "10" of the rock area 0.1.
std::string value_label(const std::string& axis, const std::string& value);
// "rock area 10 %", "downhill", "Full level".
std::string value_title(const std::string& axis, const std::string& value);
std::string panel_title(const Panel& panel);
// All axes but those in `without`.
std::string cell_title(const Cell& cell, const Cell& without);

}  // namespace rover::campaign
