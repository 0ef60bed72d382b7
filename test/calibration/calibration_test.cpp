// Each tool's file gives back the rig that it was written from.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "calibration/cameras_yaml.hpp"
#include "calibration/read.hpp"
#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/frames.hpp"

namespace rover::calibration {
namespace {

namespace fs = std::filesystem;

class Calibration : public testing::Test {
 protected:
  Calibration() : dir_(fs::path(testing::TempDir()) / ("calibration-" + std::to_string(getpid()))) {
    fs::create_directories(dir_);
    truth_.width = 1024;
    truth_.height = 768;
    truth_.left = {835.0, 836.0, 514.6, 381.2, {-0.081, 0.043, 0.0004, -0.0003, 0.0}};
    truth_.right = {835.8, 836.3, 509.6, 384.4, {-0.079, 0.041, -0.0002, 0.0005, 0.0}};
    truth_.T_left_right = make_pose(rotation_from_rpy(0.002, -0.003, 0.0015), {0.12, 0.0003, -0.0002});
  }
  ~Calibration() override { fs::remove_all(dir_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(dir_ / name) << text;
    return dir_ / name;
  }

  static std::string matrix(const Eigen::Matrix4d& m) {
    std::string out;
    for (int r = 0; r < 4; ++r)
      out += fmt::format("  - [{:.17g}, {:.17g}, {:.17g}, {:.17g}]\n", m(r, 0), m(r, 1), m(r, 2), m(r, 3));
    return out;
  }
  static std::string kalibr_camera(const PinholeCamera& c) {
    return fmt::format(
        "  camera_model: pinhole\n  intrinsics: [{}, {}, {}, {}]\n  distortion_model: radtan\n"
        "  distortion_coeffs: [{}, {}, {}, {}]\n  resolution: [1024, 768]\n  rostopic: /cam\n",
        c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3]);
  }
  // Kalibr's T_cn_cnm1 takes points of the camera before into this one.
  std::string kalibr() const {
    return "cam0:\n" + kalibr_camera(truth_.left) + "  T_cam_imu:\n" + matrix(T_left_imu_.matrix()) + "cam1:\n" +
           kalibr_camera(truth_.right) + "  T_cn_cnm1:\n" + matrix(truth_.T_left_right.inverse().matrix());
  }

  void write_opencv(const std::string& intrinsics, const std::string& extrinsics, int coefficients) const {
    cv::FileStorage in(intrinsics, cv::FileStorage::WRITE);
    const auto camera = [](const PinholeCamera& c) {
      return cv::Mat(cv::Matx33d(c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1));
    };
    const auto distortion = [coefficients](const PinholeCamera& c) {
      cv::Mat out = cv::Mat::zeros(1, coefficients, CV_64F);
      for (int i = 0; i < 5; ++i) out.at<double>(i) = c.distortion[static_cast<size_t>(i)];
      return out;
    };
    in << "M1" << camera(truth_.left) << "D1" << distortion(truth_.left) << "M2" << camera(truth_.right) << "D2"
       << distortion(truth_.right);
    const Eigen::Isometry3d T = truth_.T_left_right.inverse();
    cv::Mat R(3, 3, CV_64F);
    cv::Mat t(3, 1, CV_64F);
    for (int r = 0; r < 3; ++r) {
      t.at<double>(r) = T.translation()(r);
      for (int c = 0; c < 3; ++c) R.at<double>(r, c) = T.linear()(r, c);
    }
    cv::FileStorage ex(extrinsics, cv::FileStorage::WRITE);
    ex << "R" << R << "T" << t;
  }

  void expect_truth(const StereoCalibration& found) const {
    for (const auto& [is, shall] : {std::pair(found.left, truth_.left), std::pair(found.right, truth_.right)}) {
      EXPECT_DOUBLE_EQ(is.fx_px, shall.fx_px);
      EXPECT_DOUBLE_EQ(is.fy_px, shall.fy_px);
      EXPECT_DOUBLE_EQ(is.cx_px, shall.cx_px);
      EXPECT_DOUBLE_EQ(is.cy_px, shall.cy_px);
      for (size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(is.distortion[i], shall.distortion[i]) << i;
    }
    EXPECT_TRUE(found.T_left_right.isApprox(truth_.T_left_right, 1e-9)) << found.T_left_right.matrix();
  }

  static std::string refusal(const std::vector<std::string>& files) {
    try {
      read_calibration(files);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "taken";
  }

  fs::path dir_;
  StereoCalibration truth_;
  Eigen::Isometry3d T_left_imu_ = make_pose(rotation_from_rpy(0.1, 0.2, 0.3), {0.01, 0.02, -0.05});
};

TEST_F(Calibration, KalibrsFileGivesTheRig) {
  const StereoCalibration found = read_calibration({write("camchain.yaml", kalibr())});
  expect_truth(found);
  EXPECT_EQ(found.width, 1024);
  EXPECT_EQ(found.height, 768);
  ASSERT_TRUE(found.T_left_imu.has_value());
  EXPECT_TRUE(found.T_left_imu->isApprox(T_left_imu_, 1e-12));
}

TEST_F(Calibration, OpenCvsTwoFilesGiveTheRig) {
  const std::string intrinsics = dir_ / "intrinsics.yml";
  const std::string extrinsics = dir_ / "extrinsics.yml";
  write_opencv(intrinsics, extrinsics, 5);
  expect_truth(read_calibration({intrinsics, extrinsics}));
  expect_truth(read_calibration({extrinsics, intrinsics}));
  write_opencv(intrinsics, extrinsics, 14);  // the unused ones are zero
  expect_truth(read_calibration({intrinsics, extrinsics}));
  EXPECT_NE(refusal({intrinsics}).find("no R"), std::string::npos);
}

// A point of the world has to fall on the pixels that the tool's own library gives it.
TEST_F(Calibration, APointFallsWhereOpenCvPutsIt) {
  const StereoCalibration found = read_calibration({write("camchain.yaml", kalibr())});
  const Eigen::Vector3d p_left(0.3, -0.2, 2.0);
  const Eigen::Vector3d p_right = found.T_left_right.inverse() * p_left;
  EXPECT_LT(p_right.x(), p_left.x());
  const Eigen::Isometry3d T = truth_.T_left_right.inverse();
  cv::Mat R(3, 3, CV_64F);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) R.at<double>(r, c) = T.linear()(r, c);
  cv::Mat rotation;
  cv::Rodrigues(R, rotation);
  const cv::Vec3d t(T.translation().x(), T.translation().y(), T.translation().z());
  const cv::Matx33d identity = cv::Matx33d::eye();
  std::vector<cv::Point2d> ideal;
  cv::projectPoints(std::vector{cv::Point3d(p_left.x(), p_left.y(), p_left.z())}, rotation, t, identity, {}, ideal);
  EXPECT_NEAR(p_right.x() / p_right.z(), ideal[0].x, 1e-9);
  EXPECT_NEAR(p_right.y() / p_right.z(), ideal[0].y, 1e-9);
}

TEST_F(Calibration, MountAndPoseAreInverse) {
  for (const double pitch_deg : {-20.0, 0.0, 33.0, 80.0})
    for (const double yaw_deg : {-90.0, 0.0, 40.0}) {
      const Mount mount{{0.5, 0.07, 0.06}, to_rad(pitch_deg), to_rad(2.0), to_rad(yaw_deg)};
      const Mount again = mount_of(pose_of(mount));
      EXPECT_NEAR(again.pitch_down_rad, mount.pitch_down_rad, 1e-12);
      EXPECT_NEAR(again.roll_rad, mount.roll_rad, 1e-12);
      EXPECT_NEAR(again.yaw_rad, mount.yaw_rad, 1e-12);
      EXPECT_EQ(again.position_m, mount.position_m);
    }
}

TEST_F(Calibration, WhatIsWrittenIsReadByTheServices) {
  const Mount mount{{0.5, 0.07, 0.06}, to_rad(33.0), to_rad(0.5), to_rad(-1.0)};
  write("cameras.yaml", cameras_yaml(ROVER_SOURCE_DIR "/config/cameras.yaml", "loccam", truth_, mount, "a test"));
  const StereoRig rig = load_stereo_rig(dir_, "loccam");
  EXPECT_EQ(rig.width, 1024);
  EXPECT_NEAR(rig.left.fy_px, 836.0, 1e-3);
  EXPECT_NEAR(rig.right.distortion[3], 0.0005, 1e-7);
  EXPECT_TRUE(rig.T_left_right.isApprox(truth_.T_left_right, 1e-6));
  EXPECT_TRUE(rig.T_body_left.isApprox(pose_of(mount), 1e-5));
  const StereoRig navcam = load_stereo_rig(dir_, "navcam");
  const StereoRig before = load_stereo_rig(ROVER_SOURCE_DIR "/config", "navcam");
  EXPECT_EQ(navcam.left.fx_px, before.left.fx_px);
  EXPECT_TRUE(navcam.T_body_left.isApprox(before.T_body_left));
}

TEST_F(Calibration, WhatCannotBeIsRefusedInOneLine) {
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string text = kalibr();
    text.replace(text.find(from), from.size(), to);
    return refusal({write("spoiled.yaml", text)});
  };
  const auto says = [](const std::string& line, const std::string& part) {
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  };
  says(refusal({dir_ / "none.yaml"}), "none.yaml: cannot be read");
  says(spoiled("radtan", "equidistant"), "distortion_model: 'equidistant'; only radtan");
  says(spoiled("pinhole", "omni"), "camera_model: 'omni'");
  says(spoiled("cam1:", "cam2:"), "neither a camchain");
  says(spoiled("resolution: [1024, 768]", "resolution: [1024]"), "resolution: 1 numbers instead of 2");
  says(spoiled("intrinsics: [835", "intrinsics: [x835"), "intrinsics: missing, or no list of numbers");
  says(spoiled("T_cn_cnm1", "T_other"), "T_cn_cnm1: missing");
  says(refusal({write("broken.yaml", "cam0: [")}), "not valid YAML");
  truth_.T_left_right.translation() *= 1000.0;  // millimetres
  says(refusal({write("mm.yaml", kalibr())}), "metres are expected");
  truth_.T_left_right.translation() *= -0.001;
  says(refusal({write("left.yaml", kalibr())}), "exchange left and right");
}

}  // namespace
}  // namespace rover::calibration
