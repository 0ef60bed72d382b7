// One panel of tiles over two axes, as SVG.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rover::campaign {

struct Rgb {
  int r = 255;
  int g = 255;
  int b = 255;
};

// Piecewise linear between stops of ascending position.
struct ColourStop {
  double at;
  Rgb colour;
};
Rgb colour_at(const std::vector<ColourStop>& scale, double position);
extern const std::vector<ColourStop> kSuccessColours;     // 0 .. 1
extern const std::vector<ColourStop> kCostColours;        // 0 (good) .. 1 (bad)
extern const std::vector<ColourStop> kDifferenceColours;  // -1 (B better) .. 1 (B worse)

enum class Outline { kNone, kMark, kAlarm };

struct Tile {
  Rgb fill;
  std::vector<std::string> lines;  // the first one is the larger
  Outline outline = Outline::kNone;
};

struct GridPicture {
  std::string title;
  std::string x_title;
  std::string y_title;
  std::vector<std::string> x_labels;
  std::vector<std::string> y_labels;       // the first one is the lowest
  std::vector<std::optional<Tile>> tiles;  // by y, then x
  int max_lines = 1;                       // room in a tile
};

// One picture as a document.
std::string grid_svg(const GridPicture& picture);
// Several on one sheet under a heading, with a scale at its end.
struct Scale {
  const std::vector<ColourStop>& colours;
  std::string low;  // text at its ends
  std::string high;
};
std::string sheet_svg(const std::string& heading, const std::string& note, const std::vector<GridPicture>& pictures,
                      const Scale& scale);
// The scale alone.
std::string scale_svg(const Scale& scale);

}  // namespace rover::campaign
