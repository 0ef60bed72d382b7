#include "mission_control/ground_map.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/geo/shaded_relief.hpp"

namespace rover::mission {
namespace {

constexpr double kSmoothingM = 0.8;  // suppresses the map's vertical noise, as in the report's relief
constexpr double kStepM = 0.5;       // sampling step of the path check
constexpr int kPictureEdgePx = 2000;

struct ColourStop {
  double at;  // slope / limit
  cv::Vec4d bgra;
};

// Green, yellow, orange, red; transparent on flat ground.
cv::Vec4b slope_colour(double ratio) {
  static const std::array<ColourStop, 5> kStops = {
      ColourStop{0.0, {120, 170, 60, 0}}, ColourStop{0.3, {110, 190, 90, 90}}, ColourStop{0.6, {60, 200, 235, 150}},
      ColourStop{1.0, {40, 110, 245, 185}}, ColourStop{1.6, {60, 40, 200, 210}}};
  const double at = std::clamp(ratio, 0.0, kStops.back().at);
  for (size_t i = 1; i < kStops.size(); ++i) {
    if (at > kStops[i].at) continue;
    const double u = (at - kStops[i - 1].at) / (kStops[i].at - kStops[i - 1].at);
    return kStops[i - 1].bgra * (1.0 - u) + kStops[i].bgra * u;
  }
  return kStops.back().bgra;
}

cv::Vec4b class_colour(double slope_rad, const SlopeLimits& limits) {
  if (slope_rad > limits.max_rad) return {70, 60, 225, 190};
  if (slope_rad > limits.steep_rad) return {50, 150, 245, 160};
  if (slope_rad > 0.5 * limits.steep_rad) return {80, 215, 235, 110};
  return {130, 190, 80, 70};
}

template <class Colour>
std::vector<std::uint8_t> png_of(const GroundHeights& heights, const std::vector<float>& slopes, Colour colour) {
  cv::Mat picture(heights.rows, heights.columns, CV_8UC4);
  for (int row = 0; row < heights.rows; ++row)
    for (int column = 0; column < heights.columns; ++column)
      picture.at<cv::Vec4b>(heights.rows - 1 - row, column) =
          colour(slopes[static_cast<size_t>(row) * heights.columns + column]);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  return bytes;
}

std::vector<float> values_of(const cv::Mat& m) {
  return {m.ptr<float>(), m.ptr<float>() + m.total()};
}

}  // namespace

GroundMap::GroundMap(GroundHeights heights, const SlopeLimits& limits, double rover_length_m)
    : heights_(std::move(heights)), limits_(limits) {
  measure_slopes(rover_length_m);
}

void GroundMap::measure_slopes(double rover_length_m) {
  const cv::Mat raw(heights_.rows, heights_.columns, CV_32F, heights_.z_m.data());
  const double sigma_px = kSmoothingM / heights_.resolution_m;
  cv::Mat z;
  cv::GaussianBlur(raw, z, cv::Size(), sigma_px, sigma_px, cv::BORDER_REPLICATE);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(z, dx, CV_32F, 1, 0, 3, 1.0 / (8.0 * heights_.resolution_m), 0.0, cv::BORDER_REPLICATE);
  cv::Sobel(z, dy, CV_32F, 0, 1, 3, 1.0 / (8.0 * heights_.resolution_m), 0.0, cv::BORDER_REPLICATE);
  cv::Mat slope(z.size(), CV_32F);
  for (int row = 0; row < z.rows; ++row)
    for (int column = 0; column < z.cols; ++column)
      slope.at<float>(row, column) = std::atan(std::hypot(dx.at<float>(row, column), dy.at<float>(row, column)));
  const int kernel_px = 2 * static_cast<int>(std::lround(0.5 * rover_length_m / heights_.resolution_m)) + 1;
  cv::Mat steepest;
  cv::dilate(slope, steepest, cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(kernel_px, kernel_px)));
  slope_rad_ = values_of(slope);
  worst_slope_rad_ = values_of(steepest);
}

std::vector<std::uint8_t> GroundMap::relief_jpeg() const {
  const HeightRaster raster{heights_.columns, heights_.rows, heights_.resolution_m, heights_.z_m};
  const double px_per_m = kPictureEdgePx / std::max(width_m(), height_m());
  return rover::relief_jpeg(raster, {0.0, 0.0, width_m(), height_m()}, static_cast<int>(width_m() * px_per_m),
                            static_cast<int>(height_m() * px_per_m), ReliefStyle{});
}

std::vector<std::uint8_t> GroundMap::slope_png() const {
  return png_of(heights_, slope_rad_, [this](double slope) { return slope_colour(slope / limits_.max_rad); });
}

std::vector<std::uint8_t> GroundMap::difficulty_png() const {
  return png_of(heights_, worst_slope_rad_, [this](double slope) { return class_colour(slope, limits_); });
}

bool GroundMap::contains(const Eigen::Vector2d& p) const {
  return p.x() >= 0.0 && p.y() >= 0.0 && p.x() < width_m() && p.y() < height_m();
}

size_t GroundMap::index_of(const Eigen::Vector2d& p) const {
  const auto column = static_cast<size_t>(p.x() / heights_.resolution_m);
  const auto row = static_cast<size_t>(p.y() / heights_.resolution_m);
  return row * static_cast<size_t>(heights_.columns) + column;
}

double GroundMap::height_at(const Eigen::Vector2d& p) const {
  return heights_.z_m[index_of(p)];
}

PathCheck GroundMap::check(const std::vector<Eigen::Vector2d>& points) const {
  PathCheck out;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d segment = points[i + 1] - points[i];
    const bool last = i + 2 == points.size();
    const int steps = std::max(1, static_cast<int>(std::ceil(std::min(segment.norm(), 1e5) / kStepM)));
    for (int k = 0; k < steps + (last ? 1 : 0); ++k) {
      const double u = static_cast<double>(k) / steps;
      const Eigen::Vector2d p = points[i] + u * segment;
      if (!contains(p)) {
        out.inside = false;
        return out;
      }
      const double slope = slope_rad_[index_of(p)];
      out.distance_m.push_back(out.length_m + u * segment.norm());
      out.slope_rad.push_back(slope);
      out.height_m.push_back(height_at(p));
      out.max_slope_rad = std::max(out.max_slope_rad, slope);
    }
    out.length_m += segment.norm();
  }
  out.passable = out.max_slope_rad <= limits_.max_rad;
  return out;
}

}  // namespace rover::mission
