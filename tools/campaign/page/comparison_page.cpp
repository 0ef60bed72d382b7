#include "tools/campaign/page/comparison_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "tools/campaign/page/comparison_lines.hpp"
#include "tools/campaign/page/grids.hpp"
#include "tools/campaign/page/page_html.hpp"
#include "tools/campaign/page/page_table.hpp"
#include "tools/report/html_parts.hpp"
#include "tools/report/svg.hpp"

namespace rover::campaign {
namespace {

using report::escaped;

constexpr size_t kMarkdownCells = 10;  // of each figure

std::string html_of(const Table& table) {
  const auto line_of = [&](const Line& line, const char* tag) {
    std::string out = "<tr>";
    for (size_t i = 0; i < line.size(); ++i)
      out += fmt::format("<{0}{1}>{2}</{0}>", tag, i < table.texts ? "" : " class=\"n\"", escaped(line[i]));
    return out + "</tr>\n";
  };
  std::string out = "<div class=\"wide\"><table>" + line_of(table.head, "th");
  for (const Line& line : table.lines) out += line_of(line, "td");
  return out + "</table></div>\n";
}

std::string markdown_of(const Table& table, size_t max_lines) {
  std::string out = markdown_line(table.head) + markdown_rule(table.head.size());
  for (size_t i = 0; i < std::min(max_lines, table.lines.size()); ++i) out += markdown_line(table.lines[i]);
  if (table.lines.size() > max_lines) out += fmt::format("\nand {} more\n", table.lines.size() - max_lines);
  return out;
}

Tile success_difference_tile(const SuccessComparison& s) {
  // The full colour is reached where half of the drives change; red is worse.
  return {colour_at(kDifferenceColours, -2.0 * s.difference),
          {signed_text(100.0 * s.difference, 0) + " %",
           signed_text(100.0 * s.interval.low, 0) + "…" + signed_text(100.0 * s.interval.high, 0),
           fmt::format("n {}", s.counts.pairs())},
          differs(s) ? Outline::kMark : Outline::kNone};
}

Tile figure_difference_tile(const FigureComparison& f, const ShownFigure& figure, double largest) {
  const Difference d = difference_of(f, figure);
  const double cost = (figure.higher_is_better ? -1.0 : 1.0) * d.value / std::max(largest, 1e-12);
  return {colour_at(kDifferenceColours, cost),
          {signed_text(d.value, d.decimals), fmt::format("n {}", f.pairs)},
          differs(f) ? Outline::kMark : Outline::kNone};
}

using TileOf = std::function<std::optional<Tile>(const PairsComparison&)>;

std::string difference_pictures(const Comparison& c, const Panels& panels, int lines, const TileOf& tile_of) {
  std::map<Cell, const PairsComparison*> cells;
  for (const CellComparison& cell : c.cells) cells[cell.cell] = &cell.pairs;
  std::vector<GridPicture> pictures;
  for (const Panel& panel : panels.panels) {
    pictures.push_back(empty_picture(panels, panel));
    pictures.back().max_lines = lines;
    for (const auto& cell : panel.cells)
      pictures.back().tiles.push_back(cell ? tile_of(*cells.at(*cell)) : std::nullopt);
  }
  return picture_row(pictures);
}

std::string listed(const Table& table) {
  if (table.lines.empty()) return "";
  return fmt::format("<details class=\"listed\"><summary>{} beyond chance</summary>{}</details>\n",
                     counted(static_cast<double>(table.lines.size()), "cell"), html_of(table));
}

std::string success_differences(const Comparison& c, const Panels& panels) {
  std::string out =
      "<h2>Success, B - A</h2><p class=\"meta\">In percentage points of the feasible pairs, with the paired 95 % "
      "interval. A "
      "frame "
      "marks a cell that differs beyond chance.</p><div class=\"scale\">" +
      scale_svg({kDifferenceColours, "B better", "B worse"}) + "</div>";
  out += difference_pictures(c, panels, 3, [](const PairsComparison& pairs) {
    return pairs.success.counts.pairs() == 0 ? std::nullopt
                                             : std::optional<Tile>(success_difference_tile(pairs.success));
  });
  return out + listed(success_cells(c, panels.common));
}

std::string figure_differences(const Comparison& c, const Panels& panels, size_t i) {
  double largest = 0.0;
  for (const CellComparison& cell : c.cells)
    if (const double d = std::abs(difference_of(cell.pairs.figures[i], kShownFigures[i]).value); std::isfinite(d))
      largest = std::max(largest, d);
  std::string out = fmt::format("<h3>{}</h3>", escaped(kShownFigures[i].title));
  out += difference_pictures(c, panels, 2, [&](const PairsComparison& pairs) {
    const FigureComparison& f = pairs.figures[i];
    return f.pairs == 0 ? std::nullopt : std::optional<Tile>(figure_difference_tile(f, kShownFigures[i], largest));
  });
  return out + listed(figure_cells(c, i, panels.common));
}

Panels panels_of_comparison(const Comparison& c) {
  std::vector<Cell> cells;
  for (const CellComparison& cell : c.cells) cells.push_back(cell.cell);
  return panels_of(cells);
}

std::string side_text(const std::string& name, const std::string& commit, const Cell& own) {
  return fmt::format("{}, commit {}{}", name, commit, own.empty() ? "" : ", " + cell_title(own, {}));
}

std::string comparison_cards(const Comparison& c) {
  const SuccessComparison& s = c.all.success;
  const auto card = [](const std::string& value, const std::string& what, const char* kind) {
    return fmt::format("<div class=\"card {}\"><b>{}</b><span>{}</span></div>\n", kind, value, what);
  };
  return "<section class=\"cards\">\n" +
         card(signed_text(100.0 * s.difference, 1) + " %",
              "success, B - A: " + interval_text({100.0 * s.interval.low, 100.0 * s.interval.high}, 1) + " (Newcombe)",
              "") +
         card(p_text(s.p), "p of this difference if all drives are independent (McNemar)", "") +
         card(fmt::format("{} / {}", s.counts.only_a, s.counts.only_b), "drives that only A / only B finished", "") +
         card(fmt::format("{:.0f} / {:.0f}", c.contacts_a, c.contacts_b), "contacts of A / of B",
              c.contacts_a + c.contacts_b == 0.0 ? "good" : "bad") +
         card(std::to_string(c.pairs), "pairs of drives", "") + "</section>\n";
}

}  // namespace

std::string comparison_html(const ComparisonInfo& info, const Comparison& c) {
  const Panels panels = panels_of_comparison(c);
  std::string body = campaign_style();
  body +=
      fmt::format("<header><div><h1>Campaigns: {} and {}</h1><div class=\"meta\">A: {}<br>B: {}</div></div></header>\n",
                  escaped(info.name_a), escaped(info.name_b), escaped(side_text(info.name_a, info.commit_a, c.only_a)),
                  escaped(side_text(info.name_b, info.commit_b, c.only_b)));
  body += comparison_cards(c) + "<p class=\"meta\">" + pairs_text(c) + ".</p>\n";
  body += "<h2>All cells together</h2>" + html_of(overall_table(c));
  body +=
      "<p class=\"meta\">" + method_text() + "</p>\n<h2>Cells that differ beyond chance</h2>" + html_of(found_table(c));
  body += "<p class=\"meta\">" + family_text(c) + "</p>\n" + success_differences(c, panels);
  body +=
      "<h2>Path, time and stops, B - A</h2><p class=\"meta\">Median of the paired differences, of counts their mean; "
      "below it the number of pairs.</p>";
  for (size_t i = 0; i < std::size(kShownFigures); ++i) body += figure_differences(c, panels, i);
  body += fmt::format("<h2>Command</h2><pre class=\"command\">{}</pre>\n", escaped(info.command));
  return report::document("Campaigns: " + info.name_a + ", " + info.name_b, body);
}

std::string comparison_table(const ComparisonInfo& info, const Comparison& c) {
  const SuccessComparison& s = c.all.success;
  const Cell common = panels_of_comparison(c).common;
  std::string out = fmt::format("# Campaigns `{}` (A) and `{}` (B)\n\n- A: {}\n- B: {}\n- command: `{}`\n- {}\n",
                                info.name_a, info.name_b, side_text(info.name_a, info.commit_a, c.only_a),
                                side_text(info.name_b, info.commit_b, c.only_b), info.command, pairs_text(c));
  out += fmt::format("- contacts: {:.0f} of A, {:.0f} of B\n", c.contacts_a, c.contacts_b);
  out += fmt::format("- success, B - A: {} % ({}; Newcombe), p {} (McNemar); only A finished {}, only B {}\n\n",
                     signed_text(100.0 * s.difference, 1),
                     interval_text({100.0 * s.interval.low, 100.0 * s.interval.high}, 1), p_text(s.p), s.counts.only_a,
                     s.counts.only_b);
  out += markdown_of(overall_table(c), 100) + "\n" + method_text() + "\n\n## Cells that differ beyond chance\n\n";
  out += markdown_of(found_table(c), 100) + "\n" + family_text(c) + "\n";
  const auto add = [&out](const std::string& title, const Table& table) {
    if (!table.lines.empty()) out += "\n### " + title + "\n\n" + markdown_of(table, kMarkdownCells);
  };
  add("Success", success_cells(c, common));
  for (size_t i = 0; i < std::size(kShownFigures); ++i) add(kShownFigures[i].title, figure_cells(c, i, common));
  return out;
}

}  // namespace rover::campaign
