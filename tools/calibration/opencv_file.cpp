// OpenCV's FileStorage. x_right = R x_left + T, as cv::stereoCalibrate() and cv::fisheye::stereoCalibrate() give them.
#include "common/bus/config.hpp"
#include "tools/calibration/read.hpp"

namespace rover::calibration {
namespace {

// Alternative key names: the stereo_calib sample's, and common hand-written ones.
using Names = std::vector<std::string>;
const Names kM1 = {"M1", "K1", "cameraMatrix1", "camera_matrix_1"};
const Names kD1 = {"D1", "distCoeffs1", "distortion_1"};
const Names kM2 = {"M2", "K2", "cameraMatrix2", "camera_matrix_2"};
const Names kD2 = {"D2", "distCoeffs2", "distortion_2"};

const ToolFile& holding(const std::vector<ToolFile>& files, const Names& names) {
  for (const ToolFile& file : files)
    if (file.has(file.name_of(names))) return file;
  const bool of_pair = names.front() == "R" || names.front() == "T";
  throw ConfigError(files.front().file() + ": no " + names.front() +
                    (of_pair ? " (name the extrinsics' file too)" : ""));
}

std::vector<double> matrix(const std::vector<ToolFile>& files, const Names& names, size_t count) {
  const ToolFile& file = holding(files, names);
  return file.numbers(file.name_of(names), count);
}

// OpenCV's files do not name the model; those of its calibrate.cpp have fisheye_model.
std::string model_in(const std::vector<ToolFile>& files) {
  for (const ToolFile& file : files) {
    if (file.has("distortion_model")) return file.text("distortion_model");
    if (file.has("fisheye_model")) return file.text("fisheye_model") == "0" ? "radtan" : "equidistant";
  }
  return {};
}

PinholeCamera camera(const std::vector<ToolFile>& files, const Names& m, const Names& d, const std::string& model) {
  const std::vector<double> M = matrix(files, m, 9);
  PinholeCamera out{M[0], M[4], M[2], M[5], {}};
  const ToolFile& file = holding(files, d);
  const std::string key = file.name_of(d);
  if (model.empty() && file.numbers(key).size() == 4)
    file.fail(key, "k1 k2 p1 p2, or k1 k2 k3 k4 of a fisheye? Set it with --model radtan or --model equidistant");
  file.set_lens(out, model.empty() ? "radtan" : model, key);
  return out;
}

}  // namespace

bool is_opencv_stereo(const ToolFile& file) {
  for (const Names& names : {kM1, kM2, Names{"R"}})
    if (file.has(file.name_of(names))) return true;
  return false;
}

StereoCalibration read_opencv(const std::vector<ToolFile>& files, const std::string& model) {
  const std::string found = model_in(files);
  if (!model.empty() && !found.empty() && found != model)
    throw ConfigError(files.front().file() + ": its model is " + found + ", not that of --model");
  const std::string used = found.empty() ? model : found;
  StereoCalibration out;
  out.left = camera(files, kM1, kD1, used);
  out.right = camera(files, kM2, kD2, used);
  const std::vector<double> R = matrix(files, {"R"}, 9);
  const std::vector<double> T = matrix(files, {"T"}, 3);
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();
  T_right_left.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
  T_right_left.translation() = Eigen::Vector3d(T[0], T[1], T[2]);
  out.T_left_right = T_right_left.inverse();
  for (const ToolFile& file : files) {
    if (const int width = file.size_px(file.name_of({"image_width", "imageWidth"}))) out.width = width;
    if (const int height = file.size_px(file.name_of({"image_height", "imageHeight"}))) out.height = height;
  }
  return out;
}

}  // namespace rover::calibration
