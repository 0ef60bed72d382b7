#include "tools/campaign/page/grid_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/palette.hpp"
#include "tools/report/svg.hpp"

namespace rover::campaign {

const std::vector<ColourStop> kSuccessColours = {
    {0.0, {158, 27, 47}}, {0.5, {232, 131, 93}}, {0.8, {251, 227, 192}}, {0.9, {223, 236, 243}}, {1.0, {88, 156, 204}}};
const std::vector<ColourStop> kCostColours = {
    {0.0, {255, 250, 243}}, {0.4, {253, 212, 158}}, {0.7, {244, 150, 98}}, {1.0, {190, 66, 32}}};
const std::vector<ColourStop> kDifferenceColours = {{-1.0, {58, 128, 184}},
                                                    {-0.4, {178, 210, 230}},
                                                    {0.0, {250, 250, 250}},
                                                    {0.4, {250, 203, 176}},
                                                    {1.0, {205, 84, 56}}};

namespace {

using report::Anchor;
using report::Svg;
namespace palette = report::palette;

constexpr double kTileWidth = 54.0;
constexpr double kFirstLine = 13.0;  // font sizes
constexpr double kLongFirstLine = 11.5;
constexpr double kOtherLine = 9.5;
constexpr double kLinePitch = 11.5;
constexpr double kTop = 24.0;
constexpr double kBottom = 36.0;
constexpr double kCharacter = 6.4;  // width at the labels' size
constexpr double kGap = 18.0;
constexpr size_t kColumns = 3;

struct GridSize {
  double left;
  double tile_width;
  double tile_height;
  double width;
  double height;
};

size_t longest(const std::vector<std::string>& labels) {
  size_t out = 0;
  for (const std::string& label : labels) out = std::max(out, label.size());
  return out;
}

GridSize size_of(const GridPicture& picture) {
  GridSize size{};
  size.left =
      8.0 + kCharacter * static_cast<double>(longest(picture.y_labels)) + (picture.y_title.empty() ? 0.0 : 18.0);
  size.tile_width = std::max(kTileWidth, kCharacter * static_cast<double>(longest(picture.x_labels)) + 8.0);
  size.tile_height = 22.0 + kLinePitch * (picture.max_lines - 1);
  size.width = size.left + size.tile_width * static_cast<double>(picture.x_labels.size()) + 4.0;
  // Room for the title above a narrow picture.
  size.width = std::max(size.width, 7.3 * static_cast<double>(picture.title.size()) + 8.0);
  size.height = kTop + size.tile_height * static_cast<double>(picture.y_labels.size()) + kBottom;
  return size;
}

std::string css(const Rgb& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b);
}

const char* ink_on(const Rgb& c) {
  return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b < 135.0 ? "#ffffff" : palette::kInk;
}

void draw_outline(Svg& svg, double x, double y, const GridSize& size, Outline outline) {
  if (outline == Outline::kNone) return;
  svg.rect(x + 2.0, y + 2.0, size.tile_width - 4.0, size.tile_height - 4.0,
           fmt::format("fill:none;stroke:{};stroke-width:2", outline == Outline::kAlarm ? "#e00000" : palette::kInk));
}

void draw_tile(Svg& svg, double x, double y, const GridSize& size, const std::optional<Tile>& tile) {
  if (!tile) {
    svg.rect(x + 1.0, y + 1.0, size.tile_width - 2.0, size.tile_height - 2.0, "fill:#f5f6f8");
    return;
  }
  svg.rect(x + 1.0, y + 1.0, size.tile_width - 2.0, size.tile_height - 2.0, "fill:" + css(tile->fill));
  const double used = 16.0 + kLinePitch * static_cast<double>(tile->lines.size() - 1);
  double line_y = y + 0.5 * (size.tile_height - used) + 12.5;
  for (size_t i = 0; i < tile->lines.size(); ++i) {
    const double first = tile->lines[0].size() > 5 ? kLongFirstLine : kFirstLine;
    svg.text(x + 0.5 * size.tile_width, line_y, tile->lines[i], i == 0 ? first : kOtherLine,
             fmt::format("fill:{}{}", ink_on(tile->fill), i == 0 ? ";font-weight:600" : ""), Anchor::kMiddle);
    line_y += kLinePitch;
  }
  draw_outline(svg, x, y, size, tile->outline);
}

void draw_labels(Svg& svg, const GridPicture& picture, const GridSize& size) {
  const std::string style = fmt::format("fill:{}", palette::kMuted);
  const size_t rows = picture.y_labels.size();
  const double bottom = kTop + size.tile_height * static_cast<double>(rows);
  svg.text(picture.title.size() > 34 ? 2.0 : size.left, 15.0, picture.title, 13, "font-weight:600");
  for (size_t i = 0; i < picture.x_labels.size(); ++i)
    svg.text(size.left + size.tile_width * (static_cast<double>(i) + 0.5), bottom + 14.0, picture.x_labels[i], 11.5,
             style, Anchor::kMiddle);
  for (size_t k = 0; k < rows; ++k)
    svg.text(size.left - 5.0, bottom - size.tile_height * (static_cast<double>(k) + 0.5) + 4.0, picture.y_labels[k],
             11.5, style, Anchor::kEnd);
  svg.text(size.left + 0.5 * size.tile_width * static_cast<double>(picture.x_labels.size()), bottom + 30.0,
           picture.x_title, 11.5, style, Anchor::kMiddle);
  svg.begin_group(fmt::format("transform=\"translate(12,{:.1f}) rotate(-90)\"", 0.5 * (kTop + bottom)));
  svg.text(0.0, 0.0, picture.y_title, 11.5, style, Anchor::kMiddle);
  svg.end();
}

void draw_grid_picture(Svg& svg, const GridPicture& picture) {
  const GridSize size = size_of(picture);
  draw_labels(svg, picture, size);
  const size_t columns = picture.x_labels.size();
  for (size_t i = 0; i < picture.tiles.size(); ++i) {
    const size_t from_top = picture.y_labels.size() - 1 - i / columns;
    draw_tile(svg, size.left + size.tile_width * static_cast<double>(i % columns),
              kTop + size.tile_height * static_cast<double>(from_top), size, picture.tiles[i]);
  }
}

// Of a sheet that is drawn at 1.5 pixels per unit: a part of a pixel would be a dark edge.
double whole_pixels(double length) {
  return 2.0 * std::ceil(0.5 * length);
}

constexpr double kScaleWidth = 420.0;
constexpr double kScaleHeight = 16.0;

void draw_scale(Svg& svg, const Scale& scale) {
  constexpr int kSteps = 60;
  constexpr double kBar = 180.0;
  const double from = 7.0 * static_cast<double>(scale.low.size()) + 6.0;
  const double first = scale.colours.front().at;
  const double range = scale.colours.back().at - first;
  svg.text(0.0, 12.0, scale.low, 11.5, "");
  for (int i = 0; i < kSteps; ++i)
    svg.rect(from + kBar * i / kSteps, 2.0, kBar / kSteps + 0.8, 12.0,
             "fill:" + css(colour_at(scale.colours, first + range * i / (kSteps - 1))));
  svg.text(from + kBar + 6.0, 12.0, scale.high, 11.5, "");
}

}  // namespace

Rgb colour_at(const std::vector<ColourStop>& scale, double position) {
  if (!(position > scale.front().at)) return scale.front().colour;
  for (size_t i = 1; i < scale.size(); ++i) {
    if (position > scale[i].at) continue;
    const double t = (position - scale[i - 1].at) / (scale[i].at - scale[i - 1].at);
    const auto mixed = [t](int a, int b) { return static_cast<int>(std::lround(a + t * (b - a))); };
    const Rgb& a = scale[i - 1].colour;
    const Rgb& b = scale[i].colour;
    return {mixed(a.r, b.r), mixed(a.g, b.g), mixed(a.b, b.b)};
  }
  return scale.back().colour;
}

std::string grid_svg(const GridPicture& picture) {
  const GridSize size = size_of(picture);
  Svg svg(size.width, size.height);
  draw_grid_picture(svg, picture);
  return svg.str();
}

std::string scale_svg(const Scale& scale) {
  Svg svg(kScaleWidth, kScaleHeight);
  draw_scale(svg, scale);
  return svg.str();
}

std::string sheet_svg(const std::string& heading, const std::string& note, const std::vector<GridPicture>& pictures,
                      const Scale& scale) {
  double cell_width = 0.0;
  double cell_height = 0.0;
  for (const GridPicture& picture : pictures) {
    cell_width = std::max(cell_width, size_of(picture).width);
    cell_height = std::max(cell_height, size_of(picture).height);
  }
  const size_t columns = std::min(kColumns, pictures.size());
  const auto rows = static_cast<double>((pictures.size() + columns - 1) / columns);
  constexpr double kHead = 64.0;
  const double text_width = 6.6 * static_cast<double>(note.size());
  const double width = whole_pixels(
      2.0 * kGap + std::max({static_cast<double>(columns) * (cell_width + kGap) - kGap, text_width, kScaleWidth}));
  const double height = whole_pixels(kHead + rows * (cell_height + kGap) + kScaleHeight + kGap);
  Svg svg(width, height);
  svg.rect(0.0, 0.0, width, height, "fill:#ffffff");
  svg.text(kGap, 28.0, heading, 18, "font-weight:700");
  svg.text(kGap, 47.0, note, 12, fmt::format("fill:{}", palette::kMuted));
  for (size_t i = 0; i < pictures.size(); ++i) {
    const double x = kGap + static_cast<double>(i % columns) * (cell_width + kGap);
    const double y = kHead + static_cast<double>(i / columns) * (cell_height + kGap);
    svg.begin_group(fmt::format("transform=\"translate({:.1f},{:.1f})\"", x, y));
    draw_grid_picture(svg, pictures[i]);
    svg.end();
  }
  svg.begin_group(fmt::format("transform=\"translate({:.1f},{:.1f})\"", kGap, height - kScaleHeight - kGap));
  draw_scale(svg, scale);
  svg.end();
  return svg.str();
}

}  // namespace rover::campaign
