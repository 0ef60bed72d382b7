#include "common/stereo/rectifier.hpp"

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "common/core/frames.hpp"

namespace rover::stereo {
namespace {

cv::Mat intrinsics(const PinholeCamera& camera) {
  return (cv::Mat_<double>(3, 3) << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
}

bool is_fisheye(const PinholeCamera& camera) {
  return camera.model == DistortionModel::kEquidistant;
}

cv::Mat distortion(const PinholeCamera& camera) {
  cv::Mat coefficients(1, is_fisheye(camera) ? 4 : 5, CV_64F);
  for (int i = 0; i < coefficients.cols; ++i) coefficients.at<double>(i) = camera.distortion[static_cast<size_t>(i)];
  return coefficients;
}

// Non-owning view.
cv::Mat view(const GrayImage& image) {
  return {image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data.data())};
}

// Rectified pixel to sheared, padded pixel: xs = u + plane(xs, v), because left pixel x with residual r maps to x - r.
cv::Matx33d shear(const DisparityPlane& plane, const MatchPad& pad) {
  const double k = 1.0 / (1.0 - plane.per_u);
  return {k, k * plane.per_v, k * plane.at_origin_px + pad.left, 0, 1, double(pad.rows), 0, 0, 1};
}

}  // namespace

Rectifier::Rectifier(const StereoRig& rig, const MatchPad& pad, std::optional<double> origin_height_m) : pad_(pad) {
  const cv::Size size(rig.width, rig.height);
  const cv::Size match_size(rig.width + pad.left + pad.right, rig.height + 2 * pad.rows);
  const Eigen::Isometry3d T_right_left = rig.T_left_right.inverse();
  cv::Mat R, t, R1, R2, P1, P2, Q;
  cv::eigen2cv(Eigen::Matrix3d(T_right_left.linear()), R);
  cv::eigen2cv(Eigen::Vector3d(T_right_left.translation()), t);
  const cv::Mat K1 = intrinsics(rig.left), K2 = intrinsics(rig.right);
  const cv::Mat D1 = distortion(rig.left), D2 = distortion(rig.right);
  if (is_fisheye(rig.left))
    cv::fisheye::stereoRectify(K1, D1, K2, D2, size, R, t, R1, R2, P1, P2, Q, cv::CALIB_ZERO_DISPARITY, size);
  else
    cv::stereoRectify(K1, D1, K2, D2, size, R, t, R1, R2, P1, P2, Q, cv::CALIB_ZERO_DISPARITY, 0.0, size);

  camera_.width = rig.width;
  camera_.height = rig.height;
  camera_.focal_px = P1.at<double>(0, 0);
  camera_.cx_px = P1.at<double>(0, 2);
  camera_.cy_px = P1.at<double>(1, 2);
  camera_.baseline_m = -P2.at<double>(0, 3) / P2.at<double>(0, 0);
  Eigen::Matrix3d R_rect_left;
  cv::cv2eigen(R1, R_rect_left);
  camera_.T_body_cam = rig.T_body_left * make_pose(R_rect_left.transpose(), Eigen::Vector3d::Zero());
  if (origin_height_m) reference_ = disparity_plane(camera_, {0, 0, -*origin_height_m}, Eigen::Vector3d::UnitZ());

  const auto make_map = [&rig](const cv::Mat& K, const cv::Mat& D, const cv::Mat& rotation, const cv::Mat& P,
                               cv::Size to) {
    Map map;
    if (is_fisheye(rig.left))
      cv::fisheye::initUndistortRectifyMap(K, D, rotation, P, to, CV_16SC2, map.xy, map.fraction);
    else
      cv::initUndistortRectifyMap(K, D, rotation, P, to, CV_16SC2, map.xy, map.fraction);
    return map;
  };
  const cv::Mat P = P1.colRange(0, 3);
  const cv::Mat to_left = cv::Mat(shear({}, pad)) * P;
  const cv::Mat to_sheared = cv::Mat(shear(reference_, pad)) * P;
  left_ = make_map(K1, D1, R1, to_left, match_size);
  right_ = make_map(K2, D2, R2, P, size);
  match_right_ = make_map(K2, D2, R2, to_sheared, match_size);
  const cv::Mat full_mask(size, CV_8UC1, cv::Scalar(255));
  cv::remap(full_mask, match_right_valid_, match_right_.xy, match_right_.fraction, cv::INTER_LINEAR,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::threshold(match_right_valid_, match_right_valid_, 254, 255, cv::THRESH_BINARY);
}

RectifiedPair Rectifier::rectify(const GrayImage& left, const GrayImage& right) const {
  RectifiedPair pair;
  pair.left = GrayImage(camera_.width, camera_.height);
  pair.right = GrayImage(camera_.width, camera_.height);
  cv::remap(view(left), pair.match_left, left_.xy, left_.fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::remap(view(right), pair.match_right, match_right_.xy, match_right_.fraction, cv::INTER_LINEAR,
            cv::BORDER_REPLICATE);
  cv::Mat out_left = view(pair.left), out_right = view(pair.right);
  pair.match_left(cv::Rect(pad_.left, pad_.rows, camera_.width, camera_.height)).copyTo(out_left);
  cv::remap(view(right), out_right, right_.xy, right_.fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return pair;
}

}  // namespace rover::stereo
