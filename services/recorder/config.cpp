#include "recorder/config.hpp"

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"

namespace rover::recorder {

RecorderConfig load_config(const std::string& file) {
  const Config yaml = Config::load(file);
  RecorderConfig config;
  config.keep.reduced = yaml.one_of("record", {"full", "reduced"}) == "reduced";
  yaml.read("images_before_s", config.keep.before_s, {0.0, 60.0});
  yaml.read("images_after_s", config.keep.after_s, {0.0, 60.0});
  yaml.read("image_every", config.keep.every, {1, 1e6});
  yaml.read("part_gb", config.part_gb, {0.0, 1e6});
  yaml.read("min_free_start_gb", config.min_free_start_gb, {0.0, 1e6});
  yaml.read("min_free_gb", config.min_free_gb, {0.0, 1e6});
  yaml.finish();
  config.keep.bulk_channels = {channel::kLocCamLeft,  channel::kLocCamRight,    channel::kNavCamLeft,
                               channel::kNavCamRight, channel::kLocCamRectLeft, channel::kLocCamRectRight,
                               channel::kDisparity,   channel::kCloud};
  return config;
}

}  // namespace rover::recorder
