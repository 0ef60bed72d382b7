// Encodes grids and camera images for the page. Each is encoded once for all pages, in the requesting thread.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "mission_control/telemetry_store.hpp"

namespace rover::mission {

class ImageCache {
 public:
  using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;
  // PNG with alpha channel.
  Bytes grid(const std::string& name, const GridContent& content);
  // JPEG.
  Bytes camera(const std::string& name, const image_t& image);

 private:
  struct Entry {
    std::int64_t seq = 0;
    Bytes bytes;
  };
  template <class Make>
  Bytes cached(const std::string& name, std::int64_t seq, Make make);

  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace rover::mission
