#include "tools/report/elevation_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/geo/jpeg.hpp"
#include "common/geo/raster_view.hpp"
#include "tools/report/map_layers.hpp"
#include "tools/report/palette.hpp"

namespace rover::report {
namespace {

constexpr double kLegend = 44.0;
constexpr double kOrbitalSmoothingM = 0.8;
constexpr char kSlam[] = "#c2185b";

// Height of each pixel, rows from the north; NaN if unobserved.
cv::Mat seen_heights(const ElevationMosaic& mosaic, const Pose2& T_odom_map, const Box& box, cv::Size size) {
  cv::Mat z(size, CV_32F);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const Eigen::Vector2d p(box.x0_m + (u + 0.5) * box.width_m() / size.width,
                              box.y1_m - (v + 0.5) * box.height_m() / size.height);
      const Eigen::Vector2d in_odom = transform(T_odom_map, p);
      z.at<float>(v, u) = mosaic.at(in_odom.x(), in_odom.y());
    }
  return z;
}

struct HeightRange {
  double low = kInfinity;
  double high = -kInfinity;
  double share(double z) const { return high > low ? std::clamp((z - low) / (high - low), 0.0, 1.0) : 0.5; }
};

HeightRange range_of(const cv::Mat& z) {
  HeightRange range;
  for (auto it = z.begin<float>(); it != z.end<float>(); ++it)
    if (std::isfinite(*it)) {
      range.low = std::min<double>(range.low, *it);
      range.high = std::max<double>(range.high, *it);
    }
  return range;
}

// Hill shading, light from the north-west, slope between pixels `reach` away. Unobserved pixels count as level.
double light_at(const cv::Mat& z, int v, int u, double step_m, int reach) {
  constexpr double kExaggeration = 1.5;
  const auto height = [&](int dv, int du) {
    const int row = std::clamp(v + dv, 0, z.rows - 1), column = std::clamp(u + du, 0, z.cols - 1);
    const float at = z.at<float>(row, column);
    return std::isfinite(at) ? at : z.at<float>(v, u);
  };
  const double gx = kExaggeration * (height(0, reach) - height(0, -reach)) / (2.0 * reach * step_m);
  const double gy = kExaggeration * (height(-reach, 0) - height(reach, 0)) / (2.0 * reach * step_m);
  const double towards_sun = (0.64 + 0.54 * gx - 0.54 * gy) / std::sqrt(1.0 + gx * gx + gy * gy);
  return std::clamp(0.55 + 0.7 * towards_sun, 0.25, 1.25);
}

cv::Mat colour_table() {
  cv::Mat shares(1, 256, CV_8U), colours;
  for (int i = 0; i < 256; ++i) shares.at<uchar>(0, i) = static_cast<uchar>(i);
  cv::applyColorMap(shares, colours, cv::COLORMAP_TURBO);
  return colours;
}

cv::Vec3b scaled(const cv::Vec3b& colour, double by) {
  return {cv::saturate_cast<uchar>(by * colour[0]), cv::saturate_cast<uchar>(by * colour[1]),
          cv::saturate_cast<uchar>(by * colour[2])};
}

// Grey orbital map where nothing was observed.
cv::Mat paint(const cv::Mat& z, const cv::Mat& ground, const HeightRange& range, double step_m, double cell_m) {
  const int reach = std::max(1, static_cast<int>(std::lround(cell_m / step_m)));
  const cv::Mat colours = colour_table();
  const cv::Vec3b grey(214, 218, 222);
  cv::Mat picture(z.size(), CV_8UC3, cv::Scalar(grey[0], grey[1], grey[2]));
  for (int v = 0; v < z.rows; ++v)
    for (int u = 0; u < z.cols; ++u) {
      const float height = z.at<float>(v, u);
      if (std::isfinite(height)) {
        const int index = static_cast<int>(std::lround(255.0 * range.share(height)));
        picture.at<cv::Vec3b>(v, u) = scaled(colours.at<cv::Vec3b>(0, index), light_at(z, v, u, step_m, reach));
      } else if (!ground.empty()) {
        picture.at<cv::Vec3b>(v, u) = scaled(grey, light_at(ground, v, u, step_m, 1));
      }
    }
  return picture;
}

void draw_colour_bar(Svg& svg, const MapView& view, const HeightRange& range) {
  constexpr double kWidth = 180.0, kHeight = 14.0;
  cv::Mat bar;
  cv::resize(colour_table(), bar, cv::Size(256, 8), 0.0, 0.0, cv::INTER_NEAREST);
  const double x = view.left + 20.0, y = view.top + 18.0;
  svg.rect(x - 10.0, y - 10.0, kWidth + 20.0, 48.0, "fill:#fff;fill-opacity:.85", 5.0);
  svg.jpeg(x, y, kWidth, kHeight, jpeg_of(bar, kMapQuality));
  svg.text(x, y + 30.0, "0", 12, "");
  svg.text(x + kWidth, y + 30.0, fmt::format("{:.1f} m", range.high - range.low), 12, "", Anchor::kEnd);
  svg.text(x + 0.5 * kWidth, y + 30.0, "mapped height", 12, "", Anchor::kMiddle);
}

void draw_corrections(Svg& svg, const MapView& view, const Scene& scene) {
  const TrueTrack truth(scene.run.truth);
  for (const CorrectionFigure& correction : scene.evaluation.metrics.global_corrections) {
    if (!correction.accepted || truth.empty()) continue;
    const Eigen::Vector2d p = view.px(Eigen::Vector2d(truth.at(correction.t_s).translation().head<2>()));
    svg.circle(p.x(), p.y(), 6.0, fmt::format("fill:{};stroke:#fff;stroke-width:2", palette::kGood));
    if (std::isfinite(correction.before_m))
      svg.text(p.x() + 9.0, p.y() - 7.0, fmt::format("{:.2f} to {:.2f} m", correction.before_m, correction.after_m), 12,
               "font-weight:600;paint-order:stroke;stroke:#fff;stroke-width:3");
  }
}

void draw_legend(Svg& svg, double left, double y) {
  const auto entry = [&](double x, const std::string& style, const std::string& text) {
    svg.line(left + x, y, left + x + 30.0, y, style);
    svg.text(left + x + 38.0, y + 4.5, text, 13, "");
  };
  entry(0.0, stroke(palette::kTruth, 3.0), "true track");
  entry(140.0, stroke(palette::kEstimate, 2.4, "stroke-dasharray:6 5"), "odometry");
  entry(270.0, stroke(kSlam, 2.2), "SLAM");
  svg.circle(left + 385.0, y, 6.0, fmt::format("fill:{};stroke:#fff;stroke-width:2", palette::kGood));
  svg.text(left + 398.0, y + 4.5, "global correction: error before and after", 13, "");
}

}  // namespace

std::string draw_elevation(const Scene& scene) {
  if (scene.run.elevation.empty()) return {};
  const MapView view = map_view(scene);
  const TrueTrack truth(scene.run.truth);
  const Window& window = scene.evaluation.metrics.window;
  const Pose2 align = start_alignment(scene.run, truth, window);
  const cv::Size size(static_cast<int>(view.width()), static_cast<int>(view.height()));
  const cv::Mat z = seen_heights(scene.run.elevation, inverse(align), view.box, size);
  const cv::Mat ground = scene.orbital.empty()
                             ? cv::Mat()
                             : heights_in(scene.orbital, view.box, size.width, size.height, kOrbitalSmoothingM);
  const HeightRange range = range_of(z);
  const double bottom = view.top + view.height() + kMapAxis + 6.0;
  Svg svg(kMapWidth, bottom + kLegend);
  svg.rect(0.0, 0.0, kMapWidth, bottom + kLegend, "fill:#fff");
  svg.begin_clip("elevation-frame", view.left, view.top, view.width(), view.height());
  svg.jpeg(
      view.left, view.top, view.width(), view.height(),
      jpeg_of(paint(z, ground, range, view.box.width_m() / size.width, scene.run.elevation.cell_m()), kMapQuality));
  svg.polyline(view.px(true_line(scene)), stroke("#ffffff", 5.0, "stroke-opacity:.7"));
  svg.polyline(view.px(true_line(scene)), stroke(palette::kTruth, 3.0));
  svg.polyline(view.px(odometry_line(scene)), stroke(palette::kEstimate, 2.2, "stroke-dasharray:6 5"));
  svg.polyline(view.px(thinned(slam_track(scene.run, truth, window).line, 0.05)), stroke(kSlam, 2.0));
  draw_corrections(svg, view, scene);
  svg.end();
  draw_axes(svg, view);
  svg.rect(view.left, view.top, view.width(), view.height(), "fill:none;stroke:#5b4636;stroke-width:1.2");
  draw_scale_bar(svg, view, true_line(scene));
  draw_north(svg, view);
  draw_colour_bar(svg, view, range);
  draw_legend(svg, view.left, bottom + 16.0);
  return svg.str();
}

}  // namespace rover::report
