// Layers of the map and its insets.
#pragma once

#include <string>
#include <vector>

#include "tools/report/scene.hpp"
#include "tools/report/svg.hpp"

namespace rover::report {

// Transforms a part of the map frame, north up, to picture coordinates.
struct MapView {
  Box box;
  double left = 0.0;
  double top = 0.0;
  double px_per_m = 1.0;
  double width() const { return box.width_m() * px_per_m; }
  double height() const { return box.height_m() * px_per_m; }
  Eigen::Vector2d px(const Eigen::Vector2d& p) const {
    return {left + (p.x() - box.x0_m) * px_per_m, top + (box.y1_m - p.y()) * px_per_m};
  }
  Points px(const Points& line) const;
};

inline constexpr double kMapWidth = 1400.0;
inline constexpr double kMapAxis = 34.0;  // margin for the axis labels, left and below

// View of the whole traverse with its planned path.
MapView map_view(const Scene& scene);
void draw_axes(Svg& svg, const MapView& view);
// Style of a line.
std::string stroke(const char* colour, double width, const std::string& more = "");

// Grows the box until height / width is in the range.
Box with_aspect(Box box, double min_ratio, double max_ratio);
Box bounds(const std::vector<Points>& lines);

enum class RockStyle { kFilled, kOutlined };  // kOutlined: over a picture that shows the rocks
void draw_rocks(Svg& svg, const MapView& view, const Scene& scene, RockStyle style);
// Lattice squares in which hazard cells were detected, without duplicates.
void draw_cells(Svg& svg, const MapView& view, const Points& cells, double cell_m, const std::string& style);
void draw_footprint(Svg& svg, const MapView& view, const Pose2& pose, const Footprint& footprint,
                    const std::string& style);
// In the lower corner that is farther from the line.
void draw_scale_bar(Svg& svg, const MapView& view, const Points& line);
void draw_north(Svg& svg, const MapView& view);
std::string incident_title(const Scene& scene, size_t index);

}  // namespace rover::report
