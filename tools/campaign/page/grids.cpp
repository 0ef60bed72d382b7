#include "tools/campaign/page/grids.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/core/frames.hpp"
#include "tools/campaign/page/statistics.hpp"
#include "tools/report/html_parts.hpp"

namespace rover::campaign {
namespace {

Tile success_tile(const Drives& drives) {
  const SuccessCount c = count(drives);
  Tile tile{{230, 232, 235}, {"none", fmt::format("0/{}", c.feasible)}};
  if (c.feasible > 0) {
    const double ratio = static_cast<double>(c.reached) / c.feasible;
    const Interval interval = wilson(c.reached, c.feasible);
    tile.fill = colour_at(kSuccessColours, ratio);
    tile.lines = {fmt::format("{:.0f} %", 100.0 * ratio), fmt::format("{}/{}", c.reached, c.feasible),
                  fmt::format("{:.0f}–{:.0f}", 100.0 * interval.low, 100.0 * interval.high)};
  }
  if (c.infeasible > 0) tile.lines.push_back(fmt::format("+{} inf.", c.infeasible));
  if (c.contacts > 0.0) {
    tile.outline = Outline::kAlarm;
    tile.lines.push_back(counted(c.contacts, "contact"));
  }
  return tile;
}

size_t max_lines_of(const std::vector<std::optional<Tile>>& tiles) {
  size_t out = 1;
  for (const auto& tile : tiles) out = std::max(out, tile ? tile->lines.size() : 0);
  return out;
}

// All panels of a page have tiles of the same size.
void equalise(std::vector<GridPicture>& pictures) {
  size_t lines = 1;
  for (const GridPicture& picture : pictures) lines = std::max(lines, max_lines_of(picture.tiles));
  for (GridPicture& picture : pictures) picture.max_lines = static_cast<int>(lines);
}

}  // namespace

GridPicture empty_picture(const Panels& panels, const Panel& panel) {
  GridPicture picture;
  picture.title = panel_title(panel);
  picture.x_title = axis_title(panels.x.name);
  picture.y_title = axis_title(panels.y.name);
  for (const std::string& value : panels.x.values) picture.x_labels.push_back(value_label(panels.x.name, value));
  for (const std::string& value : panels.y.values) picture.y_labels.push_back(value_label(panels.y.name, value));
  return picture;
}

std::vector<GridPicture> success_pictures(const Panels& panels, const Drives& drives) {
  const std::map<Cell, Drives> cells = by_cell(drives);
  std::vector<GridPicture> pictures;
  for (const Panel& panel : panels.panels) {
    pictures.push_back(empty_picture(panels, panel));
    for (const auto& cell : panel.cells)
      pictures.back().tiles.push_back(cell ? std::optional<Tile>(success_tile(cells.at(*cell))) : std::nullopt);
  }
  equalise(pictures);
  return pictures;
}

FigurePictures figure_pictures(const Panels& panels, const Drives& drives, const ShownFigure& figure) {
  std::map<Cell, Spread> spreads;
  FigurePictures out{{}, kNaN, kNaN};
  double low = kInfinity;
  double high = -kInfinity;
  for (const auto& [cell, of_cell] : by_cell(drives)) {
    spreads[cell] = spread(of_cell, figure);
    if (spreads[cell].drives == 0) continue;
    low = std::min(low, spreads[cell].median);
    high = std::max(high, spreads[cell].median);
  }
  if (low > high) return out;
  out.best = figure.higher_is_better ? high : low;
  out.worst = figure.higher_is_better ? low : high;
  for (const Panel& panel : panels.panels) {
    out.pictures.push_back(empty_picture(panels, panel));
    for (const auto& cell : panel.cells) {
      if (!cell || spreads.at(*cell).drives == 0) {
        out.pictures.back().tiles.emplace_back();
        continue;
      }
      const Spread& s = spreads.at(*cell);
      const double cost = high > low ? (s.median - out.best) / (out.worst - out.best) : 0.0;
      out.pictures.back().tiles.push_back(
          Tile{colour_at(kCostColours, cost),
               {report::shown(s.median, figure.decimals), report::shown(s.worst, figure.decimals)}});
    }
  }
  equalise(out.pictures);
  return out;
}

}  // namespace rover::campaign
