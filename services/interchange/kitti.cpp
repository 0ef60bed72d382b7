#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/bus/config.hpp"
#include "common/core/frames.hpp"
#include "interchange/stereo_data_set.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

using Matrix34d = Eigen::Matrix<double, 3, 4>;

std::ifstream open_text(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw ConfigError(file.string() + ": cannot be read");
  return in;
}

[[noreturn]] void fail(const fs::path& file, int line, const std::string& what) {
  throw ConfigError(file.string() + ":" + std::to_string(line) + ": " + what);
}

// Rows of twelve numbers, in front of which a name and a colon may stand.
std::vector<Matrix34d> read_matrices(const fs::path& file) {
  std::ifstream in = open_text(file);
  std::vector<Matrix34d> matrices;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (const size_t colon = line.find(':'); colon != std::string::npos) line = line.substr(colon + 1);
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream numbers(line);
    Matrix34d m;
    for (int i = 0; i < 12; ++i)
      if (!(numbers >> m(i / 4, i % 4)) || !std::isfinite(m(i / 4, i % 4))) fail(file, number, "not twelve numbers");
    std::string rest;
    if (numbers >> rest) fail(file, number, "more than twelve numbers");
    matrices.push_back(m);
  }
  return matrices;
}

std::vector<fs::path> pictures_in(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(dir))
    if (entry.path().extension() == ".png" || entry.path().extension() == ".jpg") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

fs::path first_folder(const fs::path& dir, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (fs::is_directory(dir / name)) return dir / name;
  throw ConfigError(dir.string() + ": no folder " + *names.begin());
}

std::vector<double> read_times(const fs::path& file, size_t count, double rate_hz) {
  std::vector<double> times;
  if (!fs::exists(file)) {
    for (size_t i = 0; i < count; ++i) times.push_back(static_cast<double>(i) / rate_hz);
    return times;
  }
  std::ifstream in = open_text(file);
  for (double t = 0.0; in >> t;) {
    if (!times.empty() && !(t > times.back())) fail(file, static_cast<int>(times.size()) + 1, "times do not rise");
    times.push_back(t);
  }
  if (times.size() < count)
    throw ConfigError(file.string() + ": " + std::to_string(times.size()) + " times for " + std::to_string(count) +
                      " pictures");
  return times;
}

// P0 and P1 are rectified: one focal length, no distortion, the right camera at +x.
StereoRig rig_from(const fs::path& file) {
  const std::vector<Matrix34d> P = read_matrices(file);
  if (P.size() < 2) throw ConfigError(file.string() + ": the projections of two cameras are expected");
  StereoRig rig;
  const auto pinhole = [](const Matrix34d& p) { return PinholeCamera{p(0, 0), p(1, 1), p(0, 2), p(1, 2), {}}; };
  rig.left = pinhole(P[0]);
  rig.right = pinhole(P[1]);
  const double baseline_m = (P[0](0, 3) - P[1](0, 3)) / P[1](0, 0);
  if (!(rig.left.fx_px > 1.0 && baseline_m > 1e-3)) throw ConfigError(file.string() + ": no stereo pair");
  rig.T_left_right.translation() = Eigen::Vector3d(baseline_m, 0.0, 0.0);
  return rig;
}

}  // namespace

StereoDataSet read_kitti(const std::string& dir, const std::string& poses, double rate_hz) {
  const fs::path root(dir);
  StereoDataSet set;
  set.layout = "KITTI";
  set.name = fs::absolute(root).lexically_normal().filename().string();
  set.rig = rig_from(root / "calib.txt");
  set.rig.T_body_left = T_body_left_camera();
  const auto left = pictures_in(first_folder(root, {"image_0", "image_l"}));
  const auto right = pictures_in(first_folder(root, {"image_1", "image_r"}));
  const auto times = read_times(root / "times.txt", left.size(), rate_hz);
  const fs::path pose_file = poses.empty() ? root / "poses.txt" : fs::path(poses);
  std::vector<Matrix34d> truth;
  if (!poses.empty() || fs::exists(pose_file)) truth = read_matrices(pose_file);
  if (!truth.empty() && truth.size() < left.size())
    throw ConfigError(pose_file.string() + ": " + std::to_string(truth.size()) + " poses for " +
                      std::to_string(left.size()) + " pictures");
  for (size_t i = 0, j = 0; i < left.size(); ++i) {
    while (j < right.size() && right[j].filename() < left[i].filename()) ++j, ++set.unpaired;
    if (j == right.size() || right[j].filename() != left[i].filename()) {
      ++set.unpaired;
      continue;
    }
    StereoPair pair{to_utime(times[i] - times[0]), left[i].string(), right[j++].string(), std::nullopt};
    if (!truth.empty()) {
      Eigen::Isometry3d T_first_left = Eigen::Isometry3d::Identity();
      T_first_left.matrix().topRows<3>() = truth[i];
      // Written with seven digits: made a rotation again.
      T_first_left.linear() = Eigen::Quaterniond(T_first_left.linear()).normalized().toRotationMatrix();
      pair.T_map_body = T_body_left_camera() * T_first_left * T_body_left_camera().inverse();
    }
    set.pairs.push_back(std::move(pair));
  }
  return set;
}

}  // namespace rover::interchange
