#include "common/geo/elevation_map_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geo/elevation_map.hpp"
#include "common/geo/open_map.hpp"
#include "common/geo/undeclared_voids.hpp"

namespace rover {
namespace {

constexpr int kStripRows = 500;  // read at once

// Width and height in blocks of n x n pixels, without heights.
ElevationRaster in_blocks(ElevationRaster frame, int n) {
  frame.width /= n;
  frame.height /= n;
  frame.resolution_m *= n;
  return frame;
}

// A void makes the sum NaN.
float mean_of_block(const ElevationRaster& part, int column, int row, int n) {
  double sum = 0.0;
  for (int y = row; y < row + n; ++y)
    for (int x = column; x < column + n; ++x) sum += part.at(x, y);
  return static_cast<float>(sum / (n * n));
}

}  // namespace

ElevationMapFile::ElevationMapFile(const std::string& file, RasterKind kind) : kind_(kind) {
  naming_errors(file, [&] { map_ = std::make_unique<OpenMap>(file, kind); });
  if (!map_->placement.is_metric())
    throw DtmError(file + ": is not in metres, north up (" + map_->placement.size() +
                   "); reproject it to metres with gdalwarp -t_srs, or cut out a part (gdal_translate -projwin)");
  const TargetGrid grid = map_->placement.own_grid();
  if (std::max(grid.width, grid.height) > std::numeric_limits<int>::max())
    throw DtmError(file + ": too large (" + map_->placement.size() + ")");
  frame_.width = static_cast<int>(grid.width);
  frame_.height = static_cast<int>(grid.height);
  frame_.resolution_m = grid.resolution_m;
  frame_.west_m = grid.west_m;
  frame_.south_m = grid.south_m;
  frame_.projection_wkt = grid.wkt;
}

ElevationMapFile::~ElevationMapFile() = default;

ElevationRaster ElevationMapFile::read(const PixelBox& box) const {
  PixelBox part;
  part.column = std::clamp(box.column, 0, frame_.width);
  part.row = std::clamp(box.row, 0, frame_.height);
  part.width = std::clamp(box.column + box.width, part.column, frame_.width) - part.column;
  part.height = std::clamp(box.row + box.height, part.row, frame_.height) - part.row;
  ElevationRaster raster = naming_errors(map_->file, [&] { return map_->band.read(part); });
  raster.resolution_m = frame_.resolution_m;
  raster.west_m = frame_.west_m + part.column * frame_.resolution_m;
  raster.south_m = frame_.south_m + part.row * frame_.resolution_m;
  raster.projection_wkt = frame_.projection_wkt;
  if (kind_ == RasterKind::kPicture) return raster;
  const UndeclaredVoids found = remove_undeclared_voids(raster, frame_.resolution_m);
  if (!found.problem.empty()) throw DtmError(map_->file + ": " + found.problem);
  return raster;
}

ElevationRaster ElevationMapFile::merged(int n) const {
  ElevationRaster result = in_blocks(frame_, n);
  result.z_m.reserve(static_cast<size_t>(result.width) * result.height);
  const int blocks = std::max(1, kStripRows / n);
  for (int row = 0; row < result.height; row += blocks) {
    const int rows = std::min(blocks, result.height - row);
    const ElevationRaster strip = read({0, row * n, frame_.width, rows * n});
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < result.width; ++x) result.z_m.push_back(mean_of_block(strip, x * n, y * n, n));
  }
  return result;
}

ElevationRaster read_for_display(const std::string& file, std::int64_t max_pixels) {
  const ElevationMapFile opened(file);
  ElevationMap map;
  map.raster = opened.merged(blocks_for(opened.frame(), max_pixels));
  require_no_voids(map, file);
  return map.raster;
}

int blocks_for(const ElevationRaster& frame, std::int64_t max_pixels) {
  const double pixels = static_cast<double>(frame.width) * frame.height;
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / static_cast<double>(max_pixels)))));
}

}  // namespace rover
