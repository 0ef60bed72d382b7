// Line plot over driven distance.
#pragma once

#include <string>
#include <vector>

#include "tools/report/polyline.hpp"
#include "tools/report/svg.hpp"

namespace rover::report {

struct Series {
  std::string name;
  std::string colour;
  double width = 1.6;
  bool dashed = false;
  Points points;  // x: distance [m], y: value; NaN breaks the line
};

struct Plot {
  std::string title;
  std::string unit;
  std::vector<Series> series;
  std::vector<double> limits;  // drawn as dashed lines
  bool from_zero = false;      // the axis includes zero
  int decimals = 2;
};

// Distances and markers of the numbered incidents.
struct PlotMarks {
  std::vector<double> at_m;
  std::vector<std::string> colours;
};

// Limits and step of an axis with about `count` round ticks that covers [low, high].
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double step = 0.5;
};
Axis round_axis(double low, double high, int count);

// Min-max envelope: at most two points in each of `columns` equal parts of the x axis.
Points envelope(const Points& points, double x_low, double x_high, int columns);

std::string draw_plot(const Plot& plot, const PlotMarks& marks, double distance_m, const std::string& id);

}  // namespace rover::report
