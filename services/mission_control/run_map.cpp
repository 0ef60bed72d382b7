#include "mission_control/run_map.hpp"

#include "common/geo/elevation_map.hpp"
#include "common/geo/elevation_map_file.hpp"

namespace rover::mission {

RunMap::RunMap(std::string run_dir, const SlopeLimits& limits, double rover_length_m)
    : run_dir_(std::move(run_dir)), limits_(limits), rover_length_m_(rover_length_m) {}

const GroundMap* RunMap::get() {
  std::call_once(read_, [this] { read(); });
  return map_.get();
}

RunMap::Bytes RunMap::picture(const std::string& name) {
  const GroundMap* map = get();
  if (map == nullptr) return nullptr;
  const std::lock_guard lock(mutex_);
  Bytes& picture = pictures_[name];
  if (!picture)
    picture = std::make_shared<const std::vector<std::uint8_t>>(name == "relief"  ? map->relief_jpeg()
                                                                : name == "slope" ? map->slope_png()
                                                                                  : map->difficulty_png());
  return picture;
}

void RunMap::read() {
  if (run_dir_.empty()) return;
  try {
    ElevationRaster raster = read_for_display(run_dir_ + "/orbital_map.tif");
    map_ = std::make_unique<GroundMap>(
        GroundHeights{raster.width, raster.height, raster.resolution_m, std::move(raster.z_m)}, limits_,
        rover_length_m_);
  } catch (const DtmError&) {  // a map is optional
  }
}

}  // namespace rover::mission
