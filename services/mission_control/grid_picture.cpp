#include "mission_control/grid_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

namespace rover::mission {
namespace {

constexpr int kFree = 0;
constexpr int kLow = 253;
constexpr int kImpassable = 254;

template <class ColourOf>
Png picture(int cells_x, int cells_y, ColourOf colour_of) {
  cv::Mat image(cells_y, cells_x, CV_8UC4);
  for (int y = 0; y < cells_y; ++y)
    for (int x = 0; x < cells_x; ++x) image.at<cv::Vec4b>(cells_y - 1 - y, x) = colour_of(x, y);
  Png bytes;
  cv::imencode(".png", image, bytes);
  return bytes;
}

cv::Vec4b mixed(const cv::Vec4d& a, const cv::Vec4d& b, double u) {
  return a * (1.0 - u) + b * u;
}

cv::Vec4b cost_colour(int cost) {
  if (cost > kImpassable) return {0, 0, 0, 0};
  if (cost == kImpassable) return {70, 60, 225, 215};
  if (cost == kLow) return {85, 95, 235, 205};
  const double u = static_cast<double>(cost - kFree) / (kLow - kFree);
  const cv::Vec4d green(120, 185, 70, 110);
  const cv::Vec4d yellow(60, 205, 240, 160);
  const cv::Vec4d orange(40, 120, 245, 190);
  return u < 0.5 ? mixed(green, yellow, 2.0 * u) : mixed(yellow, orange, 2.0 * u - 1.0);
}

}  // namespace

Png hazards_png(const std::vector<std::uint8_t>& cells, int cells_x, int cells_y) {
  // UNSEEN, FREE, OBSTACLE, HOLE, MARGIN, LOW
  static const std::array<cv::Vec4b, 6> kColours = {cv::Vec4b{0, 0, 0, 0},        cv::Vec4b{140, 200, 80, 95},
                                                    cv::Vec4b{70, 60, 235, 235},  cv::Vec4b{200, 60, 160, 235},
                                                    cv::Vec4b{60, 165, 250, 150}, cv::Vec4b{85, 105, 240, 215}};
  return picture(cells_x, cells_y, [&](int x, int y) {
    const std::uint8_t cell = cells[static_cast<size_t>(y) * cells_x + x];
    return cell < kColours.size() ? kColours[cell] : kColours[0];
  });
}

Png traversability_png(const std::vector<std::uint8_t>& costs, int cells_x, int cells_y) {
  return picture(cells_x, cells_y,
                 [&](int x, int y) { return cost_colour(costs[static_cast<size_t>(y) * cells_x + x]); });
}

Png elevation_png(const std::vector<float>& heights_m, int cells_x, int cells_y, double cell_m) {
  const auto at = [&](int x, int y) {
    return heights_m[static_cast<size_t>(std::clamp(y, 0, cells_y - 1)) * cells_x + std::clamp(x, 0, cells_x - 1)];
  };
  float low = INFINITY;
  float high = -INFINITY;
  for (const float z : heights_m) {
    if (!std::isfinite(z)) continue;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  const double span = std::max(0.3, static_cast<double>(high) - low);
  return picture(cells_x, cells_y, [&](int x, int y) {
    const float z = at(x, y);
    if (!std::isfinite(z)) return cv::Vec4b{0, 0, 0, 0};
    const double west = at(x - 1, y);
    const double north = at(x, y + 1);
    const double light = std::isfinite(west) && std::isfinite(north) ? ((z - west) - (z - north)) / cell_m : 0.0;
    const cv::Vec4b colour = mixed({120, 60, 40, 200}, {200, 230, 245, 200}, (z - low) / span);
    const double shade = std::clamp(1.0 + 0.6 * light, 0.5, 1.3);
    return cv::Vec4b(cv::saturate_cast<uchar>(colour[0] * shade), cv::saturate_cast<uchar>(colour[1] * shade),
                     cv::saturate_cast<uchar>(colour[2] * shade), colour[3]);
  });
}

}  // namespace rover::mission
