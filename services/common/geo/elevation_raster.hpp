// A raster of heights with its georeference: pixel (0, 0) is the south-west one, columns grow eastwards, rows
// northwards. In the map frame the raster's lower left corner is the origin, so pixel (i, j) is centred on (i + 1/2, j
// + 1/2) pixels.
#pragma once

#include <string>
#include <vector>

namespace rover {

// What a file's bands hold.
enum class RasterKind {
  kHeights,  // one band, in metres after conversion
  kPicture,  // brightness: the mean of the colour bands
};

// Columns from the west, rows from the south.
struct PixelBox {
  int column = 0;
  int row = 0;
  int width = 0;
  int height = 0;
};

struct ElevationRaster {
  int width = 0;
  int height = 0;
  double resolution_m = 0.0;
  double west_m = 0.0;  // of the lower left corner, in the projection
  double south_m = 0.0;
  std::string projection_wkt;
  std::vector<float> z_m;  // row by row from the south

  double width_m() const { return width * resolution_m; }
  double height_m() const { return height * resolution_m; }
  float at(int column, int row) const { return z_m[static_cast<size_t>(row) * width + column]; }
  float& at(int column, int row) { return z_m[static_cast<size_t>(row) * width + column]; }
};

// A plane that rises by the slope towards the given direction (0: east, counter-clockwise), lowest pixel at 0.
ElevationRaster plane_raster(double width_m, double height_m, double resolution_m, double slope_rad, double toward_rad);

}  // namespace rover
