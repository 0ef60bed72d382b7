// Small data sets in the layouts of KITTI and EuRoC, and the output of ./rover import.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "tools/interchange/import_data_set.hpp"
#include "tools/interchange/stereo_data_set.hpp"

namespace rover::interchange {

namespace fs = std::filesystem;

inline void write_text(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

inline void write_picture(const fs::path& file, int grey, int width = 64, int height = 48) {
  fs::create_directories(file.parent_path());
  cv::imwrite(file.string(), cv::Mat(height, width, CV_8UC1, cv::Scalar(grey)));
}

class ImportTest : public testing::Test {
 protected:
  // Three pairs; the car drives 1 m forward (z of the camera), then 1 m to the right.
  void make_kitti() {
    for (int i = 0; i < 3; ++i) {
      const std::string name = "00000" + std::to_string(i) + ".png";
      write_picture(data_ / "image_0" / name, 10 + i);
      write_picture(data_ / "image_1" / name, 20 + i);
    }
    write_text(data_ / "calib.txt", "P0: 700 0 32 0 0 701 24 0 0 0 1 0\nP1: 700 0 32 -350 0 701 24 0 0 0 1 0\n");
    write_text(data_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 1 0 1 0 0 0 0 1 1\n");
  }
  // Sensor frame with z along the optical axis; the left camera is 0.1 m above its origin, the right one 0.11 m beside
  // it. The truth is given 5 ms before and after the second image.
  void make_euroc() {
    const auto sensor = [](const std::string& x) {
      return "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, " + x +
             ", 0, 1, 0, -0.1, 0, 0, 1, 0, 0, 0, 0, 1]\nrate_hz: 20\nresolution: [64, 48]\ncamera_model: pinhole\n"
             "intrinsics: [458.6, 457.3, 30.2, 24.4]\ndistortion_model: radial-tangential\n"
             "distortion_coefficients: [-0.28, 0.07, 0.0002, 1.7e-05]\n";
    };
    write_text(data_ / "mav0/cam0/sensor.yaml", sensor("0"));
    write_text(data_ / "mav0/cam1/sensor.yaml", sensor("0.11"));
    write_text(data_ / "mav0/cam0/data.csv", "#timestamp [ns],filename\r\n1000000000,a.png\r\n1050000000,b.png\r\n");
    write_text(data_ / "mav0/cam1/data.csv",
               "#timestamp [ns],filename\r\n1000000000,a.png\r\n1020000000,x.png\r\n1050000000,b.png\r\n");
    for (const char* camera : {"cam0", "cam1"})
      for (const char* name : {"a.png", "b.png"}) write_picture(data_ / "mav0" / camera / "data" / name, 50);
    write_text(data_ / "mav0/imu0/sensor.yaml", "T_BS:\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
    // Turns about the optical axis, against which gravity pulls.
    write_text(data_ / "mav0/imu0/data.csv",
               "#timestamp [ns],w,w,w,a,a,a\n985000000,0,0,0.1,0,0,9.8\n995000000,0,0,0.3,0,0,9.8\n"
               "1015000000,0,0,0.4,0,0,9.8\n");
    write_text(data_ / "mav0/state_groundtruth_estimate0/data.csv",
               "#timestamp, p, q\n1000000000,1,2,3,0.92387953,0,0.38268343,0\n"
               "1045000000,1,2,4,0.92387953,0,0.38268343,0\n1055000000,1,2,6,0.92387953,0,0.38268343,0\n");
  }

  ImportOptions options() const {
    return {.data_set = data_.string(), .out = out_.string(), .config_dir = ROVER_SOURCE_DIR "/config"};
  }
  std::string refusal(const ImportOptions& asked) {
    try {
      import_data_set(asked);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "not refused";
  }
  void expect_refused(const std::string& part) {
    const std::string line = refusal(options());
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_FALSE(fs::exists(out_));
    EXPECT_FALSE(fs::exists(out_.string() + ".unfinished"));
  }

  testing_support::TempFolder folder_;
  fs::path data_ = folder_.path() / "06";
  fs::path out_ = folder_.path() / "run";
};

}  // namespace rover::interchange
