#include "rover_simulator/lens_faults.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr double kFogBlurPx = 4.0;  // standard deviation in full fog
constexpr double kFogGrey = 170.0;
constexpr double kSpotRadiusPx = 25.0;
constexpr double kDirtGrey = 40.0;

void move(cv::Mat& image, const CameraFault& fault) {
  const double c = std::cos(to_rad(fault.roll_deg)), s = std::sin(to_rad(fault.roll_deg));
  const double x = 0.5 * (image.cols - 1), y = 0.5 * (image.rows - 1);
  const cv::Matx23d to_moved(c, -s, x - c * x + s * y + fault.shift_columns, s, c,
                             y - s * x - c * y + fault.shift_rows);
  cv::warpAffine(image.clone(), image, to_moved, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
}

void fog(cv::Mat& image, double amount) {
  cv::GaussianBlur(image, image, {}, kFogBlurPx * amount);
  image.convertTo(image, -1, 1.0 - amount, kFogGrey * amount);
}

// Spots are laid until they cover the fraction.
void dirt(cv::Mat& image, double fraction) {
  cv::Mat mask(image.size(), CV_32F, cv::Scalar(0.0));
  std::mt19937 random(1);  // its numbers are the same everywhere, unlike those of distributions
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  while (cv::mean(mask)[0] < fraction)
    cv::circle(mask, {below(image.cols), below(image.rows)}, static_cast<int>(kSpotRadiusPx), 1.0, cv::FILLED);
  cv::GaussianBlur(mask, mask, {}, 0.2 * kSpotRadiusPx);
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column) {
      auto& pixel = image.at<std::uint8_t>(row, column);
      const double covered = mask.at<float>(row, column);
      pixel = cv::saturate_cast<std::uint8_t>((1.0 - covered) * pixel + covered * kDirtGrey);
    }
}

void glare(cv::Mat& image, double radius) {
  const double sigma_px = radius * image.cols, x = 0.5 * image.cols, y = 0.25 * image.rows;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column) {
      const double square = ((column - x) * (column - x) + (row - y) * (row - y)) / (sigma_px * sigma_px);
      auto& pixel = image.at<std::uint8_t>(row, column);
      pixel = cv::saturate_cast<std::uint8_t>(pixel + 2.0 * 255.0 * std::exp(-0.5 * square));
    }
}

}  // namespace

GrayImage seen_with(const CameraFault& fault, GrayImage image) {
  if (fault == CameraFault{}) return image;
  cv::Mat view(image.height, image.width, CV_8U, image.data.data());
  if (fault.shift_rows != 0 || fault.shift_columns != 0 || fault.roll_deg != 0.0) move(view, fault);
  if (fault.glare > 0.0) glare(view, fault.glare);
  if (fault.fog > 0.0) fog(view, fault.fog);
  if (fault.dirt > 0.0) dirt(view, fault.dirt);
  if (fault.blind) view.setTo(0);
  return image;
}

}  // namespace rover
