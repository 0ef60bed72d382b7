#include "tools/orbital_planner/files.hpp"

#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/streams.hpp"
#include "common/core/frames.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "tools/orbital_planner/convert.hpp"
#include "tools/orbital_planner/layers_file.hpp"
#include "tools/orbital_planner/picture.hpp"

namespace rover::orbital {
namespace {

void write_text(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw ConfigError(file + ": cannot be written");
}

void write_log(const std::string& file, path_t message) {
  message.header.seq = 1;
  message.header.boot_id = 1;
  message.header.publisher = "orbital_planner";
  std::vector<std::uint8_t> bytes = encoded(message);
  lcm::LogFile log(file, "w");
  lcm::LogEvent event{};
  event.channel = channel::kGlobalPath;
  event.datalen = static_cast<int>(bytes.size());
  event.data = bytes.data();
  if (!log.good() || log.writeEvent(&event) != 0) throw ConfigError(file + ": cannot be written");
}

void write_picture(const std::string& file, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(file, picture);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw ConfigError(file + ": cannot be written");
}

}  // namespace

void write_files(const std::string& dir, const ElevationMap& map, const Geography& geography, const Plan& plan,
                 const Line& waypoints, const PathTerms& terms) {
  if (map.converted) write_geotiff(dir + "/map.tif", map.raster);
  const auto place = [&](const Eigen::Vector2d& p) { return geography.is_known() ? geography.to_lon_lat(p) : p; };
  write_text(dir + "/path.geojson", geojson_from(plan, waypoints, place));
  write_text(dir + "/path.yaml", yaml_from(plan, terms));
  write_log(dir + "/path.lcm", message_from(plan, terms));
  write_picture(dir + "/path.png", draw(map.raster, plan, waypoints));
  write_layers(dir + "/terrain.tif", map.raster, plan.terrain);
}

}  // namespace rover::orbital
