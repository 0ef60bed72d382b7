#include "tools/orbital_planner/picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace rover::orbital {
namespace {

using Eigen::Vector2d;

constexpr double kMarginM = 40.0;  // around the path
constexpr int kLongSide = 1000;    // of the picture
constexpr int kShift = 4;          // OpenCV draws in sixteenths of a pixel
const cv::Vec3f kObstacle(52, 66, 176), kSteep(66, 140, 214), kUnknown(96, 96, 96);

// Displayed part of the map, in cells from the south-west.
struct Cut {
  int x0, y0, x1, y1;
  double pixels_per_cell;
};

Cut cut_around(const ElevationRaster& map, const Line& line) {
  Vector2d low = line.front(), high = line.front();
  for (const Vector2d& p : line) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const auto cell = [&](double m, int cells) {
    return std::clamp(static_cast<int>(std::floor(m / map.resolution_m)), 0, cells - 1);
  };
  Cut cut{cell(low.x() - kMarginM, map.width), cell(low.y() - kMarginM, map.height),
          cell(high.x() + kMarginM, map.width) + 1, cell(high.y() + kMarginM, map.height) + 1, 1.0};
  cut.pixels_per_cell = static_cast<double>(kLongSide) / std::max(cut.x1 - cut.x0, cut.y1 - cut.y0);
  return cut;
}

// Hill shading: light from the north-west, elevation 40 deg, heights doubled.
float light_at(const ElevationRaster& map, int x, int y) {
  const auto z = [&](int i, int j) {
    return map.at(std::clamp(i, 0, map.width - 1), std::clamp(j, 0, map.height - 1));
  };
  const float gx = (z(x + 1, y) - z(x - 1, y)) / static_cast<float>(map.resolution_m);
  const float gy = (z(x, y + 1) - z(x, y - 1)) / static_cast<float>(map.resolution_m);
  constexpr float kSunXY = 0.5417f, kSunZ = 0.6428f;
  const float light = (kSunZ + kSunXY * gx - kSunXY * gy) / std::sqrt(1.0f + gx * gx + gy * gy);
  return std::isfinite(light) ? std::clamp(0.5f + 0.75f * (light - kSunZ), 0.0f, 1.0f) : 0.5f;
}

cv::Vec3f colour_at(const ElevationRaster& map, const TerrainLayers& terrain, int x, int y) {
  const cv::Vec3f dark(92, 118, 146), bright(222, 236, 247);
  const cv::Vec3f ground = dark + (bright - dark) * light_at(map, x, y);
  switch (terrain.terrain_class[static_cast<size_t>(y) * terrain.width + x]) {
    case TerrainClass::kUnknown:
      return kUnknown;
    case TerrainClass::kObstacle:
      return 0.55f * ground + 0.45f * kObstacle;
    case TerrainClass::kSteep:
    case TerrainClass::kRough:
      return 0.75f * ground + 0.25f * kSteep;
    default:
      return ground;
  }
}

cv::Mat draw_ground(const ElevationRaster& map, const TerrainLayers& terrain, const Cut& cut) {
  cv::Mat cells(cut.y1 - cut.y0, cut.x1 - cut.x0, CV_32FC3);
  for (int y = cut.y0; y < cut.y1; ++y)
    for (int x = cut.x0; x < cut.x1; ++x)
      cells.at<cv::Vec3f>(cut.y1 - 1 - y, x - cut.x0) = colour_at(map, terrain, x, y);
  cv::Mat large, picture;
  cv::resize(cells, large, {}, cut.pixels_per_cell, cut.pixels_per_cell,
             cut.pixels_per_cell > 1.0 ? cv::INTER_LINEAR : cv::INTER_AREA);
  large.convertTo(picture, CV_8UC3);
  return picture;
}

class Pen {
 public:
  Pen(cv::Mat& picture, const ElevationRaster& map, const Cut& cut)
      : picture_(picture),
        scale_(cut.pixels_per_cell / map.resolution_m),
        west_m_(cut.x0 * map.resolution_m),
        north_m_(cut.y1 * map.resolution_m) {}

  void line(const Vector2d& a, const Vector2d& b, const cv::Scalar& colour, int width) {
    cv::line(picture_, at(a), at(b), colour, width, cv::LINE_AA, kShift);
  }
  void dot(const Vector2d& p, const cv::Scalar& colour, int radius) {
    cv::circle(picture_, at(p), radius << kShift, colour, cv::FILLED, cv::LINE_AA, kShift);
  }
  void text(const std::string& text, int x, int y) {
    cv::putText(picture_, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {255, 255, 255}, 4, cv::LINE_AA);
    cv::putText(picture_, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {30, 30, 30}, 1, cv::LINE_AA);
  }
  void bar(int x, int y, int length, const cv::Scalar& colour) {
    cv::line(picture_, {x, y}, {x + length, y}, {255, 255, 255}, 9, cv::LINE_AA);
    cv::line(picture_, {x, y}, {x + length, y}, colour, 5, cv::LINE_AA);
  }
  double pixels(double m) const { return m * scale_; }

 private:
  cv::Point at(const Vector2d& p) const {
    return {static_cast<int>(std::lround((p.x() - west_m_) * scale_ * (1 << kShift))),
            static_cast<int>(std::lround((north_m_ - p.y()) * scale_ * (1 << kShift)))};
  }

  cv::Mat& picture_;
  double scale_;
  double west_m_;
  double north_m_;
};

// 1, 2 or 5 times a power of ten, about a sixth of the picture's width.
double scale_bar_m(double picture_m) {
  const double power = std::pow(10.0, std::floor(std::log10(picture_m / 6.0)));
  for (double step : {5.0, 2.0})
    if (step * power <= picture_m / 6.0) return step * power;
  return power;
}

void draw_legend(Pen& pen, const cv::Mat& picture) {
  const int y = picture.rows - 24;
  pen.bar(20, y - 60, 40, colour_of(Level::kEfficient));
  pen.text("Efficient", 70, y - 55);
  pen.bar(20, y - 30, 40, colour_of(Level::kFull));
  pen.text("Full", 70, y - 25);
  const double bar_m = scale_bar_m(picture.cols / pen.pixels(1.0));
  const int length = static_cast<int>(std::lround(pen.pixels(bar_m)));
  pen.bar(20, y, length, {30, 30, 30});
  pen.text(cv::format("%g m", bar_m), 30 + length, y + 5);
}

}  // namespace

cv::Scalar colour_of(Level level) {
  return level == Level::kFull ? cv::Scalar(0, 94, 213) : cv::Scalar(178, 114, 0);
}

cv::Mat draw(const ElevationRaster& map, const Plan& plan, const Line& waypoints) {
  const Cut cut = cut_around(map, plan.line);
  cv::Mat picture = draw_ground(map, plan.terrain, cut);
  Pen pen(picture, map, cut);
  for (const Zone& zone : plan.zones)
    for (size_t i = 0; i < zone.points.size(); ++i)
      pen.line(zone.points[i], zone.points[(i + 1) % zone.points.size()],
               zone.keep_in ? cv::Scalar(90, 150, 40) : cv::Scalar(40, 40, 200), 3);
  for (size_t i = 1; i < plan.line.size(); ++i) pen.line(plan.line[i - 1], plan.line[i], {255, 255, 255}, 7);
  for (size_t i = 1; i < plan.line.size(); ++i)
    pen.line(plan.line[i - 1], plan.line[i], colour_of(plan.level[i - 1]), 4);
  for (const Vector2d& p : waypoints) {
    pen.dot(p, {255, 255, 255}, 9);
    pen.dot(p, {30, 30, 30}, 6);
  }
  draw_legend(pen, picture);
  return picture;
}

}  // namespace rover::orbital
