#include "tools/campaign/page/page_html.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/campaign/page/grids.hpp"
#include "tools/campaign/page/statistics.hpp"
#include "tools/report/html_parts.hpp"
#include "tools/report/svg.hpp"

namespace rover::campaign {
namespace {

using report::escaped;
using report::shown;

constexpr char kPanelStyle[] = R"css(
.grids{display:grid;grid-template-columns:repeat(auto-fill,minmax(310px,1fr));gap:10px 26px;align-items:start}
.scale svg{margin:4px 0 12px}
h3{font-size:15px;margin:22px 0 2px}
pre{margin:2px 0 12px}
pre.command{user-select:all;cursor:copy;white-space:pre-wrap;overflow-wrap:anywhere;padding:7px 10px}
.drive{margin:8px 0 0}
.wide{overflow-x:auto}.wide td,.wide th{white-space:nowrap}.wide td:first-child{white-space:normal;min-width:110px}
@media(max-width:420px){.grids{grid-template-columns:1fr}}
@media print{.grids{grid-template-columns:repeat(2,1fr);gap:6px 18px}h3{break-after:avoid}.drive{break-after:avoid}pre.command{font-size:8.5px}
 .scale{break-after:avoid}.wide td,.wide th{white-space:normal}.wide table{font-size:9px}
 .listed:not([open])::details-content{content-visibility:hidden;display:none}}
)css";

std::string page_header(const PageInfo& info, const Panels& panels, const SuccessCount& all) {
  const bool clean = all.contacts == 0.0 && all.unknown_contacts == 0;
  const std::string badge = clean                ? "No contact"
                            : all.contacts > 0.0 ? counted(all.contacts, "contact")
                                                 : std::string("Contacts unknown");
  const std::string common = cell_title(panels.common, {});
  return fmt::format(
      "<header><div><h1>Campaign: {}</h1><div class=\"meta\">{}{}commit {}{}{} &middot; {}</div></div>"
      "<div class=\"badge {}\">{}</div></header>\n",
      escaped(info.name), escaped(common), common.empty() ? "" : " &middot; ", escaped(info.commit),
      info.part.empty() ? "" : " &middot; ", info.part, escaped(info.machine), clean ? "good" : "bad", badge);
}

std::string page_card(const std::string& value, const std::string& what, const char* kind = "") {
  return fmt::format("<div class=\"card {}\"><b>{}</b><span>{}</span></div>\n", kind, value, what);
}

std::string median_card(const Drives& drives, const char* key, const char* what) {
  for (const ShownFigure& figure : kShownFigures)
    if (std::string(figure.key) == key) {
      const Spread s = spread(drives, figure);
      return page_card(shown(s.median, 2), fmt::format("{}, median; worst {}", what, shown(s.worst, 2)));
    }
  return "";
}

std::string page_cards(const SuccessCount& all, const Drives& drives) {
  std::string out = "<section class=\"cards\">\n";
  out += page_card(fmt::format("{} of {}", all.reached, all.feasible),
                   fmt::format("feasible drives reach the goal: {}", success_text(all.reached, all.feasible)));
  out += page_card(std::to_string(all.infeasible),
                   fmt::format("of {} infeasible for the oracle{}", counted(all.drives, "drive"),
                               all.without_oracle > 0 ? fmt::format("; {} without oracle", all.without_oracle) : ""));
  out += page_card(fmt::format("{:.0f}", all.contacts),
                   all.unknown_contacts > 0 ? "contacts; unknown in " + counted(all.unknown_contacts, "drive")
                                            : "contacts in " + counted(all.drives - all.died, "drive"),
                   all.contacts > 0.0          ? "bad"
                   : all.unknown_contacts == 0 ? "good"
                                               : "");
  out += median_card(drives, "regret", "driven / oracle");
  out += median_card(drives, "progress", "progress");
  return out + "</section>\n";
}

std::string success_section(const Panels& panels, const Drives& drives, const SuccessCount& all) {
  std::string out =
      "<h2>Success</h2><p class=\"meta\">Feasible drives that reach their goal without contact; below: number, and 95 "
      "% "
      "interval (Wilson). <b>inf.</b>: drives that are infeasible for the oracle, which knows all rocks; they are not "
      "counted.";
  if (repeats_flat_cells(panels)) out += " Flat ground has no direction: its drives are shown in each panel.";
  if (all.reached_infeasible > 0)
    out += fmt::format(" {} of the infeasible drives reached the goal: there the oracle is too strict.",
                       all.reached_infeasible);
  out += "</p><div class=\"scale\">" + scale_svg({kSuccessColours, "0 %", "100 %"}) + "</div>";
  return out + picture_row(success_pictures(panels, drives));
}

std::string figures_section(const Panels& panels, const Drives& drives) {
  std::string out =
      "<h2>Path, time and stops</h2><p class=\"meta\">Median of the feasible drives, below it the worst one; darker is "
      "worse. The first "
      "two figures are of drives that reached their goal.</p>";
  for (const ShownFigure& figure : kShownFigures) {
    const FigurePictures made = figure_pictures(panels, drives, figure);
    out += fmt::format("<h3>{}</h3>", escaped(figure.title));
    if (made.pictures.empty()) {
      out += "<p class=\"meta\">not in the rows</p>";
      continue;
    }
    if (made.best != made.worst)
      out += "<div class=\"scale\">" +
             scale_svg({kCostColours, shown(made.best, figure.decimals), shown(made.worst, figure.decimals)}) +
             "</div>";
    out += picture_row(made.pictures);
  }
  return out;
}

std::string cause_section(const PageInfo& info, const Panels& panels, const Cause& cause, int drives) {
  const auto n = static_cast<int>(cause.drives.size());
  std::string out =
      fmt::format("<h3>{}: {}, {:.1f} %</h3>", escaped(cause.name), counted(n, "drive"), 100.0 * n / drives);
  for (size_t i = 0; i < std::min(kWorstDrives, cause.drives.size()); ++i) {
    const Row& row = *cause.drives[i];
    const std::string facts = drive_facts(row);
    out += fmt::format("<p class=\"drive\">{}<span class=\"meta\">{}{}</span></p><pre class=\"command\">{}</pre>\n",
                       escaped(drive_title(row, panels.common)), facts.empty() ? "" : " &middot; ", escaped(facts),
                       escaped(info.repeat(row)));
  }
  return out;
}

std::string causes_section(const PageInfo& info, const Panels& panels, const Drives& drives) {
  const std::vector<Cause> found = causes(drives);
  if (found.empty()) return "<h2>Failures by cause</h2><p>None.</p>\n";
  std::string out = fmt::format(
      "<h2>Failures by cause</h2><p class=\"meta\">The {} worst drives of each: those with contact, then those with "
      "the "
      "lowest progress. The command repeats the drive with full recording; a click selects it.</p>",
      kWorstDrives);
  for (const Cause& cause : found) out += cause_section(info, panels, cause, static_cast<int>(drives.size()));
  return out;
}

}  // namespace

std::string campaign_style() {
  return fmt::format("<style>{}</style>", kPanelStyle);
}

std::string picture_row(const std::vector<GridPicture>& pictures) {
  std::string out = "<div class=\"grids\">";
  for (const GridPicture& picture : pictures) out += "<figure>" + grid_svg(picture) + "</figure>";
  return out + "</div>\n";
}

std::string success_text(int reached, int of) {
  if (of == 0) return "n/a";
  const Interval interval = wilson(reached, of);
  return fmt::format("{:.1f} % ({:.1f}–{:.1f})", 100.0 * reached / of, 100.0 * interval.low, 100.0 * interval.high);
}

std::string drive_title(const Row& row, const Cell& common) {
  const std::string cell = cell_title(row.cell, common);
  return cell + (cell.empty() ? "" : ", ") + "seed " + std::to_string(row.seed);
}

std::string drive_facts(const Row& row) {
  std::string out;
  const auto add = [&out](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  const double contacts = figure_of(row, "collisions");
  if (contacts > 0.0) add(counted(contacts, "contact"));
  if (std::isfinite(figure_of(row, "progress"))) add("progress " + shown(figure_of(row, "progress"), 2));
  if (std::isfinite(figure_of(row, "driven_length_m")))
    add(fmt::format("{} driven for {} planned", shown(figure_of(row, "driven_length_m"), 1, "m"),
                    shown(figure_of(row, "planned_length_m"), 1, "m")));
  if (std::isfinite(figure_of(row, "duration_s"))) add(shown(figure_of(row, "duration_s"), 0, "s"));
  return out;
}

std::string page_html(const PageInfo& info, const Panels& panels, const Drives& drives) {
  const SuccessCount all = count(drives);
  std::string body = campaign_style() + page_header(info, panels, all) + page_cards(all, drives);
  if (all.died > 0)
    body += fmt::format("<p class=\"meta\">{} ended without a result (died): a failure too.</p>",
                        counted(all.died, "drive"));
  body += success_section(panels, drives, all) + causes_section(info, panels, drives) + figures_section(panels, drives);
  body += fmt::format("<h2>Command</h2><pre class=\"command\">{}</pre>\n", escaped(info.command));
  body += fmt::format(
      "<section class=\"definition\"><details><summary>campaign.yaml</summary><pre>{}</pre></details></section>\n",
      escaped(info.definition));
  return report::document("Campaign: " + info.name, body);
}

}  // namespace rover::campaign
