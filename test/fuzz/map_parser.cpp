#include "common/geo/elevation_map.hpp"
#include "common/geo/geography.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "corpus.hpp"
#include "parsers.hpp"

namespace rover::fuzz {
namespace {

namespace fs = std::filesystem;

std::string plain_geotiff() {
  ElevationRaster raster = plane_raster(8.0, 6.0, 1.0, 0.1, 0.3);
  std::string name = (fs::temp_directory_path() / "rover-fuzz-map-XXXXXX").string();
  const fs::path dir = mkdtemp(name.data());
  write_geotiff(dir / "plain.tif", raster);
  const std::string bytes = bytes_of(dir / "plain.tif");
  fs::remove_all(dir);
  return bytes;
}

void run_map(const std::vector<Input>& corpus, const Input& input, Scratch& scratch) {
  lay_out(corpus, input, scratch);
  const ElevationMap map = read_elevation_map(scratch.dir() + "/" + input.name);
  const Geography geography(map.raster);
  geography.to_map(geography.to_lon_lat({1.0, 1.0}));
}

}  // namespace

Parser maps_parser() {
  std::vector<Input> corpus = files_of("maps");
  corpus.push_back({"plain.tif", plain_geotiff()});
  return {"maps",
          corpus,
          {"NODATA_value ", "nan", "-9999", "cellsize", "\n"},
          [corpus](const Input& input, Scratch& scratch) { run_map(corpus, input, scratch); }};
}

}  // namespace rover::fuzz
