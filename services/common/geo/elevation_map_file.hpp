// An elevation map, or a picture of the ground, that is read in parts, because it can be larger than the memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/geo/elevation_raster.hpp"

namespace rover {

struct OpenMap;

// Throws only DtmError. Voids that the file does not declare are detected in each part on its own.
class ElevationMapFile {
 public:
  // Reads no heights. The map must be north-up with square pixels in true metres (elevation_map.hpp).
  explicit ElevationMapFile(const std::string& file, RasterKind kind = RasterKind::kHeights);
  ~ElevationMapFile();

  // The map's size and georeference, without heights.
  const ElevationRaster& frame() const { return frame_; }
  // Columns and rows beyond the map are cut off. NaN: void. Of a picture z_m is the brightness.
  ElevationRaster read(const PixelBox& box) const;
  // Means of blocks of n x n pixels; a block with a void is void. Columns and rows that fill no block are left out.
  ElevationRaster merged(int n) const;

 private:
  RasterKind kind_;
  std::unique_ptr<OpenMap> map_;
  ElevationRaster frame_;
};

// Smallest n for which blocks of n x n pixels number at most `max_pixels`.
int blocks_for(const ElevationRaster& frame, std::int64_t max_pixels);

// A map without voids, merged to at most `max_pixels`, for a picture.
ElevationRaster read_for_display(const std::string& file, std::int64_t max_pixels = 4'000'000);

}  // namespace rover
