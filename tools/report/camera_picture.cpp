#include "tools/report/camera_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/geo/jpeg.hpp"
#include "tools/report/palette.hpp"
#include "tools/report/svg.hpp"

namespace rover::report {
namespace {

constexpr double kSide = 340.0;  // as draw_incident
constexpr double kLookBackS = 3.0;

std::vector<std::uint8_t> grey_jpeg(const CameraPicture& picture) {
  const cv::Mat grey(picture.height, picture.width, CV_8U, const_cast<std::uint8_t*>(picture.grey.data()));
  return jpeg_of(grey, kCameraQuality);
}

const HazardMap* map_of(const RunRecord& run, double exposure_s) {
  constexpr double kSame = 1e-6;
  const auto it = std::find_if(run.hazards.begin(), run.hazards.end(),
                               [&](const HazardMap& map) { return std::abs(map.t_s - exposure_s) < kSame; });
  return it == run.hazards.end() ? nullptr : &*it;
}

}  // namespace

double exposure_behind(const RunRecord& run, double t_s) {
  double newest = kNaN;
  for (auto map = run.hazards.rbegin(); map != run.hazards.rend(); ++map) {
    if (map->released_s > t_s) continue;
    if (std::isnan(newest)) newest = map->t_s;
    if (map->t_s < t_s - kLookBackS) break;
    if (!map->cells.empty()) return map->t_s;
  }
  return newest;
}

std::optional<Eigen::Vector2d> pixel_of(const CameraView& view, const HazardCell& cell, double origin_height_m) {
  const Eigen::Vector3d p_body(cell.p_body.x(), cell.p_body.y(), -origin_height_m);
  const Eigen::Vector3d p = view.T_body_cam.inverse() * p_body;
  if (p.z() <= 0.1) return std::nullopt;
  return Eigen::Vector2d(view.cx_px + view.focal_px * p.x() / p.z(), view.cy_px + view.focal_px * p.y() / p.z());
}

std::string draw_camera(const CameraPicture& picture, const RunRecord& run, double origin_height_m) {
  if (picture.width <= 0 || picture.height <= 0) return {};
  const double scale = kSide / picture.width;
  const double height = scale * picture.height;
  Svg svg(kSide, height);
  svg.jpeg(0.0, 0.0, kSide, height, grey_jpeg(picture));
  const HazardMap* map = picture.rectified ? map_of(run, picture.t_s) : nullptr;
  if (map != nullptr)
    for (const HazardCell& cell : map->cells) {
      const auto px = pixel_of(*picture.rectified, cell, origin_height_m);
      if (!px || px->x() < 0.0 || px->y() < 0.0 || px->x() >= picture.width || px->y() >= picture.height) continue;
      svg.circle(px->x() * scale, px->y() * scale, 3.0,
                 fmt::format("fill:{};fill-opacity:.75;stroke:#fff;stroke-width:.8",
                             cell.hole ? palette::kHole : palette::kHazard));
    }
  svg.rect(6.0, height - 22.0, 178.0, 17.0, "fill:#000;fill-opacity:.55", 3.0);
  svg.text(12.0, height - 9.5, fmt::format("LocCam, exposed at {:.2f} s", picture.t_s), 11.5, "fill:#fff");
  return svg.str();
}

}  // namespace rover::report
