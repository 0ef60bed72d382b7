#include "tools/report/camera_reader.hpp"

#include <cmath>
#include <map>
#include <rover/disparity_t.hpp>
#include <rover/image_t.hpp>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/streams.hpp"

namespace rover::report {
namespace {

struct Wanted {
  CameraPicture picture;
  bool rectified = false;
  std::optional<CameraView> view;
};

bool read_image(const LogEvent& event, Wanted& wanted) {
  image_t image;
  if (!find_channel_type(event.channel)->decodes(event.data, event.size)) return false;
  if (!decode_message(event.data, event.size, image) || image.encoding != image_t::MONO8) return false;
  if (image.width <= 0 || image.height <= 0 || image.size != image.width * image.height) return false;
  wanted.picture.t_s = to_seconds(image.header.utime);
  wanted.picture.width = image.width;
  wanted.picture.height = image.height;
  wanted.picture.grey = std::move(image.data);
  return true;
}

void take(const LogEvent& event, Wanted& wanted) {
  if (event.channel == channel::kLocCamRectLeft) {
    wanted.rectified = read_image(event, wanted) || wanted.rectified;
  } else if (event.channel == channel::kLocCamLeft && !wanted.rectified) {
    read_image(event, wanted);
  } else if (event.channel == channel::kDisparity) {
    disparity_t disparity;
    if (find_channel_type(event.channel)->decodes(event.data, event.size) &&
        decode_message(event.data, event.size, disparity))
      wanted.view = {disparity.focal_px, disparity.cx_px, disparity.cy_px,
                     rover::pose_from(disparity.position_body_cam_m, disparity.quat_body_cam_wxyz)};
  }
}

}  // namespace

std::vector<std::optional<CameraPicture>> read_camera_pictures(const LogRun& run,
                                                               const std::vector<double>& exposures_s) {
  std::map<Utime, Wanted> wanted;
  for (const double t_s : exposures_s)
    if (std::isfinite(t_s)) wanted[to_utime(t_s)];
  if (!wanted.empty())
    for_each_event(run, [&](const LogEvent& event) {
      header_t header{};
      if (!event.channel.starts_with("LOCCAM") && event.channel != channel::kDisparity) return;
      if (!peek_header(event.data, event.size, header)) return;
      if (const auto it = wanted.find(header.utime); it != wanted.end()) take(event, it->second);
    });
  std::vector<std::optional<CameraPicture>> pictures;
  for (const double t_s : exposures_s) {
    const auto it = std::isfinite(t_s) ? wanted.find(to_utime(t_s)) : wanted.end();
    if (it == wanted.end() || it->second.picture.grey.empty()) {
      pictures.emplace_back();
      continue;
    }
    pictures.emplace_back(it->second.picture);
    if (it->second.rectified) pictures.back()->rectified = it->second.view;
  }
  return pictures;
}

}  // namespace rover::report
