// Writes a large map for ./rover bench large_map.
//   make_large_map MAP.tif SIDE_M RESOLUTION_M OUT.tif
#include <cstdio>
#include <string>

#include "common/geo/elevation_map.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "test/geo/stretched_terrain.hpp"

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::fprintf(stderr, "usage: make_large_map MAP.tif SIDE_M RESOLUTION_M OUT.tif\n");
    return 2;
  }
  const rover::ElevationRaster small = rover::read_elevation_map(argv[1]).raster;
  rover::write_geotiff(argv[4],
                       rover::testing_support::stretched_terrain(small, std::stod(argv[2]), std::stod(argv[3])));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_large_map: %s\n", error.what());
  return 2;
}
