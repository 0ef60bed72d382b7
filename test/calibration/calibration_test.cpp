// The file of each tool restores the rig that it was written from.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/frames.hpp"
#include "test/wild.hpp"
#include "tools/calibration/cameras_yaml.hpp"
#include "tools/calibration/read.hpp"

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
  // Kalibr's T_cn_cnm1 transforms points of the previous camera into this one.
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

// A world point must project to the same pixels as with OpenCV's own functions.
TEST_F(Calibration, ProjectionMatchesOpenCv) {
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

TEST_F(Calibration, ServicesReadTheOutput) {
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

TEST_F(Calibration, ImplausibleRigIsRefusedInOneLine) {
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string text = kalibr();
    text.replace(text.find(from), from.size(), to);
    return refusal({write("spoiled.yaml", text)});
  };
  const auto says = [](const std::string& line, const std::string& part) {
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  };
  says(refusal({dir_ / "none.yaml"}), "none.yaml: no such file");
  says(refusal({dir_}), ": not a file");
  says(spoiled("radtan", "equidistant"), "one camera is equidistant, the other radtan");
  says(spoiled("cam1:", "cam2:"), "cam1: missing");
  says(spoiled("cam0:", "cam2:"), "neither a camchain");
  says(spoiled("resolution: [1024, 768]", "resolution: [1024]"), "resolution: 1 numbers instead of 2");
  says(spoiled("intrinsics: [835", "intrinsics: [x835"), "intrinsics: 'x835' is not a number");
  says(spoiled("T_cn_cnm1", "T_other"), "T_cn_cnm1: missing");
  says(refusal({write("broken.yaml", "cam0: [")}), "not valid YAML");
  truth_.T_left_right.translation() *= 1000.0;  // millimetres
  says(refusal({write("mm.yaml", kalibr())}), "a baseline of 120");
  truth_.T_left_right.translation() *= -0.001;
  says(refusal({write("left.yaml", kalibr())}), "exchange left and right");
}

// Real-world file variants; the baseline shows what was read.
class WildCalibration : public Calibration {
 protected:
  static std::string outcome(const std::vector<std::string>& files, const std::string& model = {}) {
    try {
      const StereoCalibration c = read_calibration(files, model);
      return fmt::format("taken: {}, baseline {:.3f} m", name_of(c.left.model), c.T_left_right.translation().x());
    } catch (const ConfigError& error) {
      return error.what();
    }
  }
  void expect(const std::string& input, const std::string& before, std::string now, const std::string& part) const {
    EXPECT_NE(now.find(part), std::string::npos) << input << ": " << now;
    EXPECT_EQ(now.find('\n'), std::string::npos) << now;
    for (size_t at; (at = now.find(dir_.string() + "/")) != std::string::npos;) now.erase(at, dir_.string().size() + 1);
    wild_row("Calibrations", input, before, now);
  }
  std::string kalibr_with(const std::string& from, const std::string& to) const {
    std::string text = kalibr();
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
    return text;
  }
  // T_imu_cam of both cameras, in place of T_cam_imu and T_cn_cnm1.
  std::string openvins() const {
    const Eigen::Isometry3d T_imu_left = T_left_imu_.inverse();
    return "%YAML:1.0 # the head that OpenCV's reader wants\n\ncam0:\n" + kalibr_camera(truth_.left) +
           "  T_imu_cam:\n" + matrix(T_imu_left.matrix()) + "cam1:\n" + kalibr_camera(truth_.right) + "  T_imu_cam:\n" +
           matrix((T_imu_left * truth_.T_left_right).matrix());
  }
  static std::string list(const Eigen::MatrixXd& m) {
    std::string out = "[";
    for (int r = 0; r < m.rows(); ++r)
      for (int c = 0; c < m.cols(); ++c) out += fmt::format("{}{:.17g}", out == "[" ? "" : ", ", m(r, c));
    return out + "]";
  }
  // As camera_calibration stores it: both cameras turned so that their rows are the baseline's.
  std::string camera_info(bool right, const std::string& model = "plumb_bob", double offset_m = kNaN) const {
    const PinholeCamera& c = right ? truth_.right : truth_.left;
    const Eigen::Vector3d x = truth_.T_left_right.translation().normalized();
    const Eigen::Vector3d y = Eigen::Vector3d::UnitZ().cross(x).normalized();
    Eigen::Matrix3d R;
    R << x.transpose(), y.transpose(), x.cross(y).transpose();
    if (right) R = R * truth_.T_left_right.linear();
    const double baseline_m =
        std::isnan(offset_m) ? (right ? truth_.T_left_right.translation().norm() : 0.0) : offset_m;
    Eigen::Matrix<double, 3, 4> P;
    P << 830.0, 0, 512, -830.0 * baseline_m, 0, 830.0, 384, 0, 0, 0, 1, 0;
    Eigen::Matrix3d K;
    K << c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1;
    const bool fisheye = model != "plumb_bob";
    return fmt::format(
        "image_width: 1024\nimage_height: 768\ncamera_name: narrow_stereo\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: {}\ndistortion_model: {}\ndistortion_coefficients:\n  rows: 1\n  cols: {}\n  data: [{}, {}, {}, "
        "{}{}]\n"
        "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: {}\nprojection_matrix:\n  rows: 3\n  cols: 4\n  data: "
        "{}\n",
        list(K), model, fisheye ? 4 : 5, c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3],
        fisheye ? "" : ", 0.0", list(R), list(P));
  }
  std::string opencv(const std::string& head, int coefficients) const {
    write_opencv(dir_ / "in.yml", dir_ / "ex.yml", coefficients);
    const auto body = [&](const char* name) {
      std::ifstream in(dir_ / name);
      std::string text{std::istreambuf_iterator<char>(in), {}};
      return text.substr(text.find("---\n") + 4);
    };
    return head + body("in.yml") + body("ex.yml");
  }
};

TEST_F(WildCalibration, KalibrsChainInOpenVinsForm) {
  const StereoCalibration found = read_calibration({write("chain.yaml", openvins())});
  expect_truth(found);
  ASSERT_TRUE(found.T_left_imu.has_value());
  EXPECT_TRUE(found.T_left_imu->isApprox(T_left_imu_, 1e-9));
  expect("Kalibr's chain in OpenVINS's form (%YAML:1.0, T_imu_cam, no T_cn_cnm1)", "'no M1'",
         outcome({dir_ / "chain.yaml"}), "taken: radtan, baseline 0.120 m");
  expect("Kalibr's chain under %YAML:1.0", "'no M1'", outcome({write("head.yaml", "%YAML:1.0\n---\n" + kalibr())}),
         "taken");
  std::string shifted = openvins();
  shifted.replace(shifted.find("cam0:\n  camera"), 6, "cam0:\n\nT_wrong:\n");
  expect("OpenVINS's chain whose keys are not indented (rpng/open_vins issue 438)", "'no M1'",
         outcome({write("shifted.yaml", shifted)}), "cam0: no value");
  expect("Kalibr's chain of the IMU without T_cn_cnm1", "'T_cn_cnm1: missing'",
         outcome({write("no_tcn.yaml", kalibr_with("T_cn_cnm1", "T_other"))}), "or T_imu_cam or T_cam_imu of both");
}

TEST_F(WildCalibration, ModelsByName) {
  const auto chain = [&](const std::string& from, const std::string& to) {
    return outcome({write("chain.yaml", kalibr_with(from, to))});
  };
  expect("Kalibr: pinhole, equidistant", "refused", chain("radtan", "equidistant"), "taken: equidistant");
  for (const char* model : {"omni", "eucm", "ds"})
    expect(std::string("Kalibr: ") + model, "refused",
           chain("camera_model: pinhole", std::string("camera_model: ") + model),
           std::string("the model '") + model + "' is not supported");
  expect("Kalibr: pinhole, fov", "refused", chain("radtan", "fov"), "the model 'fov' is not supported");
  expect("Kalibr: a resolution that is missing", "'resolution: missing'", chain("  resolution: [1024, 768]\n", ""),
         "taken");
}

TEST_F(WildCalibration, OpenCvsFilesUnderAnyHead) {
  for (const char* head :
       {"%YAML:1.0\n", "%YAML:1.0\n---\n", "%YAML 1.0\n---\n", "%YAML 1.1\n---\n", "%YAML 1.2\n---\n", ""}) {
    std::string shown = head;
    std::replace(shown.begin(), shown.end(), '\n', ' ');
    expect("OpenCV's file under '" + shown + "' (opencv issues 5836, 22118)",
           std::string(head).starts_with("%YAML:1.0") ? "taken" : "taken for Kalibr's and refused",
           outcome({write("stereo.yml", opencv(head, 5))}), "taken: radtan, baseline 0.120 m");
    expect_truth(read_calibration({dir_ / "stereo.yml"}));
  }
  for (const char* ending : {".xml", ".json"}) {
    const std::string in = dir_ / (std::string("in") + ending);
    const std::string ex = dir_ / (std::string("ex") + ending);
    write_opencv(in, ex, 5);
    expect_truth(read_calibration({in, ex}));
    expect(std::string("OpenCV's two files as *") + ending, ending[1] == 'x' ? "taken" : "refused", outcome({in, ex}),
           "taken");
  }
  expect("OpenCV: a cut XML file", "cv::Exception's text",
         outcome({write("cut.xml", "<?xml version=\"1.0\"?>\n<opencv_storage>\n<M1")}), "not valid XML");
}

TEST_F(WildCalibration, OpenCvsFourCoefficientsNeedAName) {
  const std::string file = write("four.yml", opencv("%YAML:1.0\n---\n", 4));
  expect("OpenCV: four coefficients, of a pinhole or a fisheye", "taken as radial-tangential", outcome({file}),
         "--model");
  EXPECT_EQ(outcome({file}, "radtan"), "taken: radtan, baseline 0.120 m");
  EXPECT_EQ(outcome({file}, "equidistant"), "taken: equidistant, baseline 0.120 m");
  expect("OpenCV: four coefficients with fisheye_model: 1", "taken as radial-tangential",
         outcome({write("named.yml", opencv("%YAML:1.0\n---\nfisheye_model: 1\n", 4))}), "taken: equidistant");
  std::string rational = opencv("%YAML:1.0\n---\n", 8);
  rational.replace(rational.rfind("0., 0., 0. ]"), 12, "0., 0., 0.1 ]");
  expect("OpenCV: the rational model", "refused", outcome({write("rational.yml", rational)}),
         "the rational model is not supported");
}

TEST_F(WildCalibration, CameraInfoOfRos) {
  const auto pair = [&](const std::string& left, const std::string& right) {
    return outcome({write("left.yaml", left), write("right.yaml", right)});
  };
  const char* unknown = "'neither a camchain of Kalibr's nor a file of OpenCV's'";
  expect("camera_info of ROS, left and right", unknown, pair(camera_info(false), camera_info(true)),
         "taken: radtan, baseline 0.120 m");
  expect_truth(read_calibration({dir_ / "left.yaml", dir_ / "right.yaml"}));
  expect("camera_info of equidistant cameras", unknown,
         pair(camera_info(false, "equidistant"), camera_info(true, "equidistant")), "taken: equidistant");
  expect("camera_info, left and right exchanged (rtabmap_ros issue 1142)", unknown,
         pair(camera_info(true), camera_info(false)), "exchange left and right");
  expect("camera_info, the right camera's P in both (rtabmap_ros issue 404)", unknown,
         pair(camera_info(false, "plumb_bob", 0.12), camera_info(true)), "its fourth number must be 0");
  expect("camera_info of two single cameras", unknown, pair(camera_info(false), camera_info(true, "plumb_bob", 0.0)),
         "calibrate the cameras as a stereo pair");
  expect("camera_info of one camera alone", unknown, outcome({dir_ / "left.yaml"}), "two files");
  std::string zeros = camera_info(true);
  const size_t at = zeros.find("data: [") + 7;
  zeros.replace(at, zeros.find(']', at) - at, "0, 0, 0, 0, 0, 0, 0, 0, 0");
  expect("camera_info whose K is all zero (depthai-ros issue 598)", unknown, pair(camera_info(false), zeros),
         "focal lengths of 0.0");
  const std::string echo =
      "header:\n  frame_id: \"cam\"\nheight: 480\nwidth: 640\ndistortion_model: \"plumb_bob\"\nD: [0.0, 0.0, 0.0, 0.0, "
      "0.0]\n"
      "K: [381.3, 0.0, 320.5, 0.0, 381.3, 240.5, 0.0, 0.0, 1.0]\nR: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\n"
      "P: [381.3, 0.0, 320.5, {}, 0.0, 381.3, 240.5, 0.0, 0.0, 0.0, 1.0, 0.0]\nbinning_x: 0\n---\n";
  std::string left = echo, right = echo;
  left.replace(left.find("{}"), 2, "0.0");
  right.replace(right.find("{}"), 2, "-45.756");
  expect("camera_info as rostopic echo shows it, with its ---", unknown, pair(left, right),
         "taken: radtan, baseline 0.120 m");
}

TEST_F(WildCalibration, RefusesFilesWithoutStereoCalibration) {
  expect(
      "OpenCV's calibration of one camera (image_common issue 27)", "'no M1'",
      outcome({write("one.yml",
                     "%YAML:1.0\nimage_width: 640\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                     "   data: [ 5.4e+02, 0., 3.3e+02, 0., 5.4e+02, 1.8e+02, 0., 0., 1. ]\n")}),
      "one.yml: a calibration of only one camera");
  expect("two documents in one file", "the second half ignored",
         outcome({write("two.yaml", kalibr() + "---\n" + kalibr())}), "a second document");
  expect("tabs before the keys", "'not valid YAML'", outcome({write("tabs.yaml", "cam0:\n\tcamera_model: pinhole\n")}),
         "tabs.yaml:2: ");
  expect("a NaN among the numbers", "taken",
         outcome({write("nan.yml",
                        [&] {
                          std::string text = opencv("%YAML:1.0\n---\n", 5);
                          return text.replace(text.rfind("data: [") + 7, 0, " .Nan, ").replace(0, 0, "");
                        }())}),
         "is not a number");
  truth_.T_left_right.translation() *= 1000.0;
  expect("a baseline of 120, in millimetres", "refused", outcome({write("mm.yaml", kalibr())}), "a baseline of 120");
  truth_.T_left_right.translation() *= -0.001;
  expect("left and right exchanged", "refused", outcome({write("exchanged.yaml", kalibr())}),
         "exchange left and right");
}

}  // namespace
}  // namespace rover::calibration
