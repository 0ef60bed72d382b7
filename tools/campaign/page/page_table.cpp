#include "tools/campaign/page/page_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/campaign/page/statistics.hpp"
#include "tools/report/html_parts.hpp"

namespace rover::campaign {
namespace {

using report::shown;

std::string success_cell(const Drives& drives) {
  const SuccessCount c = count(drives);
  const Interval interval = wilson(c.reached, c.feasible);
  std::string text = c.feasible == 0 ? "none feasible"
                                     : fmt::format("{}/{} ({:.0f}–{:.0f} %)", c.reached, c.feasible,
                                                   100.0 * interval.low, 100.0 * interval.high);
  if (c.infeasible > 0) text += fmt::format(", +{} inf.", c.infeasible);
  if (c.contacts > 0.0) text += ", **" + counted(c.contacts, "contact") + "**";
  return text;
}

std::string panel_table(const Panels& panels, const Panel& panel, const std::map<Cell, Drives>& cells) {
  const std::string title = panel_title(panel);
  std::string corner = axis_title(panels.x.name);
  if (!panels.y.name.empty()) corner = axis_title(panels.y.name) + " \\ " + corner;
  std::vector<std::string> head = {corner};
  for (const std::string& value : panels.x.values) head.push_back(value_label(panels.x.name, value));
  std::string out =
      (title.empty() ? "" : "\n### " + title + "\n") + "\n" + markdown_line(head) + markdown_rule(head.size());
  for (size_t y = 0; y < panels.y.values.size(); ++y) {
    std::vector<std::string> line = {value_label(panels.y.name, panels.y.values[y])};
    for (size_t x = 0; x < panels.x.values.size(); ++x) {
      const auto& cell = panel.cells[y * panels.x.values.size() + x];
      line.push_back(cell ? success_cell(cells.at(*cell)) : "");
    }
    out += markdown_line(line);
  }
  return out;
}

Drives drives_of(const Panel& panel, const std::map<Cell, Drives>& cells) {
  Drives out;
  std::set<Cell> seen;
  for (const auto& cell : panel.cells)
    if (cell && seen.insert(*cell).second) out.insert(out.end(), cells.at(*cell).begin(), cells.at(*cell).end());
  return out;
}

std::vector<ShownFigure> table_figures(const Drives& drives) {
  std::vector<ShownFigure> figures(std::begin(kShownFigures), std::end(kShownFigures));
  for (const ShownFigure& figure : kTableFigures)
    if (std::any_of(drives.begin(), drives.end(),
                    [&](const Row* row) { return std::isfinite(figure_of(*row, figure.key)); }))
      figures.push_back(figure);
  return figures;
}

std::string median_line_of(const std::string& title, const Drives& drives, const std::vector<ShownFigure>& figures) {
  const SuccessCount c = count(drives);
  std::vector<std::string> line = {title,
                                   std::to_string(c.drives),
                                   std::to_string(c.infeasible),
                                   fmt::format("{}/{}", c.reached, c.feasible),
                                   success_text(c.reached, c.feasible),
                                   fmt::format("{:.0f}", c.contacts)};
  for (const ShownFigure& figure : figures) {
    const Spread s = spread(drives, figure);
    line.push_back(shown(s.median, figure.decimals) + " / " + shown(s.worst, figure.decimals));
  }
  return markdown_line(line);
}

std::string summary(const Panels& panels, const Drives& drives, const std::map<Cell, Drives>& cells) {
  std::vector<std::string> head = {"", "drives", "infeasible", "goal reached", "success (95 %)", "contacts"};
  const std::vector<ShownFigure> figures = table_figures(drives);
  for (const ShownFigure& figure : figures) {
    const std::string title = figure.title;
    head.push_back(title.substr(0, title.find(':')) + ", median / worst");
  }
  std::string out =
      "\n" + markdown_line(head) + markdown_rule(head.size()) + median_line_of("**all**", drives, figures);
  if (panels.panels.size() > 1)
    for (const Panel& panel : panels.panels)
      out += median_line_of(panel_title(panel), drives_of(panel, cells), figures);
  return out;
}

// Of a campaign of one cell: each drive.
std::string drives_table(Drives drives) {
  std::sort(drives.begin(), drives.end(), [](const Row* a, const Row* b) { return a->seed < b->seed; });
  std::vector<std::string> head = {"seed", "outcome", "contacts"};
  const std::vector<ShownFigure> figures = table_figures(drives);
  for (const ShownFigure& figure : figures) head.push_back(figure.title);
  std::string out = "\n" + markdown_line(head) + markdown_rule(head.size());
  for (const Row* row : drives) {
    std::vector<std::string> line = {std::to_string(row->seed), row->outcome, shown(figure_of(*row, "collisions"), 0)};
    for (const ShownFigure& figure : figures) line.push_back(shown(figure_of(*row, figure.key), figure.decimals));
    out += markdown_line(line);
  }
  return out;
}

std::string causes_table(const PageInfo& info, const Panels& panels, const Drives& drives) {
  const std::vector<Cause> found = causes(drives);
  if (found.empty()) return "\nNo drive failed.\n";
  std::string out = "\n" + markdown_line({"cause", "drives", "worst drive", "command"}) + markdown_rule(4);
  for (const Cause& cause : found) {
    const Row& row = *cause.drives.front();
    out += markdown_line({cause.name, std::to_string(cause.drives.size()),
                          drive_title(row, panels.common) + (drive_facts(row).empty() ? "" : ": ") + drive_facts(row),
                          "`" + info.repeat(row) + "`"});
  }
  return out;
}

}  // namespace

std::string markdown_line(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) {
    out += " ";
    for (const char c : cell) out += c == '|' ? "\\|" : std::string(1, c == '\n' ? ' ' : c);
    out += cell.empty() ? "|" : " |";
  }
  return out + "\n";
}

std::string markdown_rule(size_t columns) {
  std::string out = "|";
  for (size_t i = 0; i < columns; ++i) out += "---|";
  return out + "\n";
}

std::string page_table(const PageInfo& info, const Panels& panels, const Drives& drives, const std::string& picture) {
  const std::map<Cell, Drives> cells = by_cell(drives);
  std::string out = fmt::format(
      "# Campaign `{}`\n\n- commit: `{}`\n- machine: {}\n{}- command: `{}`, then `{}`\n", info.name, info.commit,
      info.machine, info.part.empty() ? "" : "- not complete: " + info.part + "\n", info.command, info.page_command);
  if (!panels.common.empty()) out += fmt::format("- all drives: {}\n", cell_title(panels.common, {}));
  out += summary(panels, drives, cells);
  out +=
      "\nSuccess and figures are of the drives that are feasible for the oracle; driven / planned and regret of those "
      "that reached their goal.";
  if (repeats_flat_cells(panels))
    out += " Flat ground has no direction: its drives are in each panel, and once in all.";
  out += "\n";
  if (cells.size() > 1) {
    const std::string and_y = panels.y.name.empty() ? "" : " and " + axis_title(panels.y.name);
    out += fmt::format("\n![Success by {}{}]({})\n", axis_title(panels.x.name), and_y, picture);
    out += "\n## Success\n";
    for (const Panel& panel : panels.panels) out += panel_table(panels, panel, cells);
  } else {
    out += "\n## Drives\n" + drives_table(drives);
  }
  return out + "\n## Failures by cause\n" + causes_table(info, panels, drives);
}

}  // namespace rover::campaign
