// OpenCV's FileStorage. x_right = R x_left + T, as cv::stereoCalibrate() gives them.
#include <opencv2/core.hpp>

#include "calibration/read.hpp"
#include "common/bus/config.hpp"
#include "common/core/frames.hpp"

namespace rover::calibration {
namespace {

// The same things by other names: the stereo_calib sample's, and those that people write by hand.
const std::vector<std::vector<std::string>> kNames = {{"M1", "K1", "cameraMatrix1", "camera_matrix_1"},
                                                      {"D1", "distCoeffs1", "distortion_1"},
                                                      {"M2", "K2", "cameraMatrix2", "camera_matrix_2"},
                                                      {"D2", "distCoeffs2", "distortion_2"},
                                                      {"R"},
                                                      {"T"}};
enum Item { kM1, kD1, kM2, kD2, kR, kT };

struct Found {
  cv::Mat values;
  std::string file;
};

cv::FileStorage open(const std::string& file) {
  try {
    cv::FileStorage storage(file, cv::FileStorage::READ);
    if (storage.isOpened()) return storage;
  } catch (const cv::Exception& error) {
    throw ConfigError(file + ": " + error.err);
  }
  throw ConfigError(file + ": cannot be read");
}

Found find(const std::vector<std::string>& files, Item item) {
  for (const std::string& file : files) {
    const cv::FileStorage storage = open(file);
    for (const std::string& name : kNames[item]) {
      if (storage[name].empty()) continue;
      cv::Mat values;
      try {
        storage[name] >> values;
      } catch (const cv::Exception&) {
      }
      if (values.empty()) throw ConfigError(file + ": " + name + ": no matrix");
      values.convertTo(values, CV_64F);
      return {values, file};
    }
  }
  throw ConfigError(files.front() + ": no " + kNames[item].front() +
                    (item >= kR ? " (name the extrinsics' file too)" : ""));
}

cv::Mat matrix(const std::vector<std::string>& files, Item item, int rows, int columns) {
  const Found found = find(files, item);
  if (found.values.rows == rows && found.values.cols == columns) return found.values;
  if (columns == 1 && found.values.rows == 1 && found.values.cols == rows) return found.values.t();
  throw ConfigError(found.file + ": " + kNames[item].front() + ": not " + std::to_string(rows) + " x " +
                    std::to_string(columns));
}

// OpenCV has up to 14 coefficients; the stack has the first five of them.
std::array<double, 5> distortion(const std::vector<std::string>& files, Item item) {
  const Found found = find(files, item);
  std::array<double, 5> out{};
  const auto count = static_cast<int>(found.values.total());
  for (int i = 0; i < count; ++i) {
    const double value = found.values.at<double>(i);
    if (i < 5)
      out[static_cast<size_t>(i)] = value;
    else if (value != 0.0)
      throw ConfigError(found.file + ": " + kNames[item].front() +
                        ": more than k1 k2 p1 p2 k3; calibrate without CALIB_RATIONAL_MODEL and the like");
  }
  return out;
}

PinholeCamera camera(const std::vector<std::string>& files, Item matrix_item, Item distortion_item) {
  const cv::Mat K = matrix(files, matrix_item, 3, 3);
  return {K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2), K.at<double>(1, 2),
          distortion(files, distortion_item)};
}

}  // namespace

StereoCalibration read_opencv(const std::vector<std::string>& files) {
  StereoCalibration out;
  out.left = camera(files, kM1, kD1);
  out.right = camera(files, kM2, kD2);
  const cv::Mat R = matrix(files, kR, 3, 3);
  const cv::Mat T = matrix(files, kT, 3, 1);
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) T_right_left.linear()(r, c) = R.at<double>(r, c);
    T_right_left.translation()(r) = T.at<double>(r);
  }
  out.T_left_right = T_right_left.inverse();
  for (const std::string& file : files) {
    const cv::FileStorage storage = open(file);
    for (const char* width : {"image_width", "imageWidth"})
      if (storage[width].isInt()) out.width = static_cast<int>(storage[width]);
    for (const char* height : {"image_height", "imageHeight"})
      if (storage[height].isInt()) out.height = static_cast<int>(storage[height]);
  }
  return out;
}

}  // namespace rover::calibration
