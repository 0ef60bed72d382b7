#include "recorder/config.hpp"

#include "common/bus/channels.hpp"

namespace rover::recorder {
namespace {

void add_keep(Parameters& p, KeepConfig& c) {
  std::string record = c.reduced ? "reduced" : "full";
  p.add_choice("record", record, {"full", "reduced"},
               "full: every message; reduced: images, disparities and clouds only around events");
  c.reduced = record == "reduced";
  p.add("images_before_s", c.images_before_s, {0.0, 60.0},
        "reduced: kept before a change of state, a repaired path or a fault");
  p.add("images_after_s", c.images_after_s, {0.0, 60.0}, "reduced: kept after it");
  p.add("image_interval", c.image_interval, {1, 1e6}, "reduced: each n-th message of a channel is kept as well");
}

}  // namespace

RecorderConfig load_config(const std::string& config_dir, ParameterList* list) {
  RecorderConfig config;
  Parameters p(config_dir + "/recorder.yaml", "Log of the run, traverse.lcm.", list);
  add_keep(p, config.keep);
  p.add("part_gb", config.part_gb, {0.0, 1e6},
        "size at which the log continues in traverse-002.lcm and so on; 0: one file");
  p.add("min_free_start_gb", config.min_free_start_gb, {0.0, 1e6}, "free disk space required to start");
  p.add("min_free_gb", config.min_free_gb, {0.0, 1e6},
        "free disk space below which recording stops while the rover drives on");
  p.finish();
  config.keep.bulk_channels = {channel::kLocCamLeft,  channel::kLocCamRight,    channel::kNavCamLeft,
                               channel::kNavCamRight, channel::kLocCamRectLeft, channel::kLocCamRectRight,
                               channel::kDisparity,   channel::kCloud};
  return config;
}

}  // namespace rover::recorder
