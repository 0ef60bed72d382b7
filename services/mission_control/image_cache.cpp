#include "mission_control/image_cache.hpp"

#include <opencv2/imgcodecs.hpp>

#include "mission_control/grid_picture.hpp"

namespace rover::mission {

template <class Make>
ImageCache::Bytes ImageCache::cached(const std::string& name, std::int64_t seq, Make make) {
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[name];
  if (!entry.bytes || entry.seq != seq) entry = {seq, std::make_shared<const std::vector<std::uint8_t>>(make())};
  return entry.bytes;
}

ImageCache::Bytes ImageCache::grid(const std::string& name, const GridContent& c) {
  return cached(name, c.seq, [&] {
    if (name == "hazards") return hazards_png(c.cells, c.cells_x, c.cells_y);
    if (name == "traversability") return traversability_png(c.cells, c.cells_x, c.cells_y);
    return elevation_png(c.heights_m, c.cells_x, c.cells_y, c.cell_m);
  });
}

ImageCache::Bytes ImageCache::camera(const std::string& name, const image_t& image) {
  return cached(name, image.header.utime, [&] {
    constexpr int kQuality = 80;
    const cv::Mat grey(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data.data()));
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", grey, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality});
    return bytes;
  });
}

}  // namespace rover::mission
