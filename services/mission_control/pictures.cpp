#include "mission_control/pictures.hpp"

#include <opencv2/imgcodecs.hpp>

#include "mission_control/grid_picture.hpp"

namespace rover::mission {

template <class Make>
Pictures::Bytes Pictures::made_once(const std::string& name, std::int64_t seq, Make make) {
  const std::lock_guard lock(mutex_);
  Made& made = made_[name];
  if (!made.bytes || made.seq != seq) made = {seq, std::make_shared<const std::vector<std::uint8_t>>(make())};
  return made.bytes;
}

Pictures::Bytes Pictures::grid(const std::string& name, const GridContent& c) {
  return made_once(name, c.seq, [&] {
    if (name == "hazards") return hazards_png(c.cells, c.cells_x, c.cells_y);
    if (name == "traversability") return traversability_png(c.cells, c.cells_x, c.cells_y);
    return elevation_png(c.heights_m, c.cells_x, c.cells_y, c.cell_m);
  });
}

Pictures::Bytes Pictures::camera(const std::string& name, const image_t& image) {
  return made_once(name, image.header.utime, [&] {
    constexpr int kQuality = 80;
    const cv::Mat grey(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data.data()));
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", grey, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality});
    return bytes;
  });
}

}  // namespace rover::mission
