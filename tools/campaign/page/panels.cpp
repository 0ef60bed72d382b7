#include "tools/campaign/page/panels.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "common/core/decimal.hpp"
#include "tools/report/svg.hpp"

namespace rover::campaign {
namespace {

constexpr char kRockArea[] = "rock_area";
constexpr char kSlope[] = "slope_deg";
constexpr char kDirection[] = "slope_direction";
constexpr char kFlat[] = "flat";
constexpr char kDefault[] = "default";

std::string value_of(const Cell& cell, const std::string& axis) {
  const auto it = cell.find(axis);
  return it == cell.end() ? kDefault : it->second;
}

// Order of values that are no numbers, where a reader expects another one than the alphabet's.
int rank_of(const std::string& value) {
  static const std::vector<std::string> kOrder = {kFlat,  "down", "across", "up",        kDefault,  "efficient",
                                                  "auto", "full", "truth",  "geometric", "rendered"};
  return static_cast<int>(std::find(kOrder.begin(), kOrder.end(), value) - kOrder.begin());
}

bool value_before(const std::string& a, const std::string& b) {
  const auto number_a = parse_number(a);
  const auto number_b = parse_number(b);
  if (number_a && number_b) return *number_a < *number_b;
  if (number_a.has_value() != number_b.has_value()) return number_a.has_value();
  return rank_of(a) != rank_of(b) ? rank_of(a) < rank_of(b) : a < b;
}

std::vector<CellAxis> axes_of(const std::vector<Cell>& cells) {
  std::map<std::string, std::set<std::string>> values;
  for (const Cell& cell : cells)
    for (const auto& [axis, value] : cell) values[axis];
  for (const Cell& cell : cells)
    for (auto& [axis, of_axis] : values) of_axis.insert(value_of(cell, axis));
  std::vector<CellAxis> axes;
  for (const auto& [axis, of_axis] : values) {
    axes.push_back({axis, {of_axis.begin(), of_axis.end()}});
    std::sort(axes.back().values.begin(), axes.back().values.end(), value_before);
  }
  return axes;
}

// The axis to draw next: the preferred one, else that with most values. Removes it from `axes`.
CellAxis taken(std::vector<CellAxis>& axes, const std::string& preferred) {
  if (axes.empty()) return {"", {""}};
  auto best = std::find_if(axes.begin(), axes.end(), [&](const CellAxis& axis) { return axis.name == preferred; });
  if (best == axes.end())
    best = std::max_element(axes.begin(), axes.end(),
                            [](const CellAxis& a, const CellAxis& b) { return a.values.size() < b.values.size(); });
  const CellAxis axis = *best;
  axes.erase(best);
  return axis;
}

bool belongs(const Cell& cell, const Cell& fixed) {
  return std::all_of(fixed.begin(), fixed.end(), [&](const auto& entry) {
    const std::string value = value_of(cell, entry.first);
    return value == entry.second || (entry.first == kDirection && value == kFlat);
  });
}

std::vector<Cell> combinations(const std::vector<Cell>& cells, const std::vector<CellAxis>& axes) {
  std::vector<Cell> found;
  // Flat cells last: they make a panel only where no direction was driven.
  for (const bool flat : {false, true})
    for (const Cell& cell : cells) {
      if ((value_of(cell, kDirection) == kFlat) != flat) continue;
      Cell fixed;
      for (const CellAxis& axis : axes) fixed[axis.name] = value_of(cell, axis.name);
      const bool present = std::any_of(found.begin(), found.end(),
                                       [&](const Cell& other) { return flat ? belongs(cell, other) : other == fixed; });
      if (!present) found.push_back(fixed);
    }
  std::sort(found.begin(), found.end(), [&](const Cell& a, const Cell& b) {
    for (const CellAxis& axis : axes)
      if (a.at(axis.name) != b.at(axis.name)) return value_before(a.at(axis.name), b.at(axis.name));
    return false;
  });
  return found;
}

Panel panel_of(const Cell& fixed, const std::vector<Cell>& cells, const CellAxis& x, const CellAxis& y) {
  Panel panel{fixed, {}};
  for (const std::string& of_y : y.values)
    for (const std::string& of_x : x.values) {
      const auto it = std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) {
        return (x.name.empty() || value_of(cell, x.name) == of_x) &&
               (y.name.empty() || value_of(cell, y.name) == of_y) && belongs(cell, fixed);
      });
      panel.cells.push_back(it == cells.end() ? std::nullopt : std::optional<Cell>(*it));
    }
  return panel;
}

struct NameAndUnit {
  std::string name;
  std::string unit;
};

NameAndUnit split_unit(const std::string& axis) {
  if (axis == kRockArea) return {"rock area", "%"};
  if (axis.find('.') != std::string::npos) return {axis, ""};  // a parameter
  std::string name = axis;
  std::string unit;
  for (const char* known : {"_deg", "_m", "_s"})
    if (name.ends_with(known)) {
      unit = known + 1;
      name.erase(name.size() - unit.size() - 1);
      break;
    }
  std::replace(name.begin(), name.end(), '_', ' ');
  return {name, unit};
}

}  // namespace

Panels panels_of(const std::vector<Cell>& cells) {
  Panels out;
  std::vector<CellAxis> varied;
  for (const CellAxis& axis : axes_of(cells)) {
    if (axis.values.size() > 1)
      varied.push_back(axis);
    else
      out.common[axis.name] = axis.values[0];
  }
  const auto varies = [&](const char* name) {
    return std::any_of(varied.begin(), varied.end(), [&](const CellAxis& axis) { return axis.name == name; });
  };
  const bool ground = varies(kRockArea) && varies(kSlope);
  out.x = taken(varied, ground ? kRockArea : "");
  out.y = taken(varied, ground ? kSlope : "");
  for (const Cell& fixed : combinations(cells, varied)) out.panels.push_back(panel_of(fixed, cells, out.x, out.y));
  return out;
}

bool repeats_flat_cells(const Panels& panels) {
  std::map<Cell, int> panels_of_cell;
  for (const Panel& panel : panels.panels)
    for (const auto& cell : panel.cells)
      if (cell && ++panels_of_cell[*cell] > 1) return true;
  return false;
}

std::string axis_title(const std::string& axis) {
  const auto [name, unit] = split_unit(axis);
  // The last key of a parameter: its whole name is longer than a panel is high.
  return unit.empty() ? name.substr(name.rfind('.') + 1) : name + " [" + unit + "]";
}

std::string value_label(const std::string& axis, const std::string& value) {
  const auto number = axis == kRockArea ? parse_number(value) : std::nullopt;
  return number ? report::number_text(100.0 * *number) : value;
}

std::string value_title(const std::string& axis, const std::string& value) {
  if (axis == kDirection) {
    if (value == "down") return "downhill";
    if (value == "up") return "uphill";
    return value == "across" ? "across the slope" : value;
  }
  if (axis == "level" && value == "full") return "Full level";
  if (axis == "level" && value == "efficient") return "Efficient level";
  if (axis == "perception") return value + " perception";
  const auto [name, unit] = split_unit(axis);
  return name + " " + value_label(axis, value) + (unit.empty() ? "" : " " + unit);
}

std::string panel_title(const Panel& panel) {
  return cell_title(panel.fixed, {});
}

std::string cell_title(const Cell& cell, const Cell& without) {
  std::string out;
  for (const auto& [axis, value] : cell)
    if (!without.contains(axis)) out += (out.empty() ? "" : ", ") + value_title(axis, value);
  return out;
}

}  // namespace rover::campaign
