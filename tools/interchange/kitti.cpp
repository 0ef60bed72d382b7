#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/frames.hpp"
#include "tools/interchange/numbered_pictures.hpp"
#include "tools/interchange/stamps.hpp"
#include "tools/interchange/stereo_data_set.hpp"
#include "tools/interchange/text_rows.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

using Matrix34d = Eigen::Matrix<double, 3, 4>;
constexpr double kMaxSeconds = 5e9;  // upper limit of times, also absolute ones: year 2128

using Pictures = std::map<std::int64_t, fs::path>;

Matrix34d matrix(const TextRows& rows, size_t first_cell) {
  if (rows.cells().size() != first_cell + 12)
    rows.fail(std::to_string(rows.cells().size() - first_cell) +
              " columns; the twelve numbers of a 3 x 4 matrix are expected");
  Matrix34d m;
  for (int i = 0; i < 12; ++i) m(i / 4, i % 4) = rows.number(first_cell + static_cast<size_t>(i));
  return m;
}

fs::path first_folder(const fs::path& dir, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (fs::is_directory(dir / name)) return dir / name;
  throw ConfigError(dir.string() + ": no folder " + *names.begin());
}

// Rows P0 and P1, or the first two if rows have no names.
std::vector<Matrix34d> read_projections(const fs::path& file) {
  TextRows rows(file.string(), ' ');
  std::vector<Matrix34d> P;
  while (rows.next() && P.size() < 2) {
    const bool named = rows.cells().front().ends_with(':');
    if (named && rows.cells().front() != "P" + std::to_string(P.size()) + ":") continue;
    P.push_back(matrix(rows, named ? 1 : 0));
    if (!P.back().allFinite()) rows.fail("not a number");
  }
  if (P.size() < 2) throw ConfigError(file.string() + ": the projections of two cameras, P0 and P1, are expected");
  return P;
}

// P0 and P1 are rectified: equal focal length, no distortion, right camera at +x.
StereoRig rig_from(const fs::path& file) {
  const std::vector<Matrix34d> P = read_projections(file);
  StereoRig rig;
  const auto pinhole = [](const Matrix34d& p) { return PinholeCamera{p(0, 0), p(1, 1), p(0, 2), p(1, 2), {}}; };
  rig.left = pinhole(P[0]);
  rig.right = pinhole(P[1]);
  for (const Matrix34d& p : P)
    if (!(p(0, 0) >= 10.0 && p(1, 1) >= 10.0 && p(0, 2) > 0.0 && p(1, 2) > 0.0))
      throw ConfigError(file.string() + ": P0 and P1 are not camera projections, f 0 cx tx 0 f cy 0 0 0 1 0");
  rig.T_left_right.translation() = Eigen::Vector3d((P[0](0, 3) - P[1](0, 3)) / P[1](0, 0), 0.0, 0.0);
  const std::string problem = problem_of_pair(rig.T_left_right);
  if (!problem.empty()) throw ConfigError(file.string() + ": " + problem);
  return rig;
}

// Image number of a file's first row: 0, or that of the first image if the file was cut with the images.
std::int64_t first_number(const fs::path& file, size_t rows, const Pictures& pictures) {
  const std::int64_t first = pictures.begin()->first;
  const std::int64_t last = pictures.rbegin()->first;
  const auto count = static_cast<std::int64_t>(rows);
  if (count > last) return 0;
  if (count == last - first + 1) return first;
  throw ConfigError(file.string() + ": " + std::to_string(count) + " rows for the images " + std::to_string(first) +
                    " to " + std::to_string(last) + "; one row for each of them, or for each from 0 on, is expected");
}

// Image number to time [ns].
std::map<std::int64_t, std::int64_t> read_times(const fs::path& file, const Pictures& pictures, double rate_hz) {
  std::map<std::int64_t, std::int64_t> times_ns;
  Stamps stamps;
  const auto nanoseconds = [](double s) { return static_cast<std::int64_t>(std::llround(s * 1e9)); };
  if (!fs::exists(file)) {
    for (const auto& [number, picture] : pictures) {
      const double after_s = static_cast<double>(number - pictures.begin()->first) / rate_hz;
      if (after_s > kMaxSeconds)
        throw ConfigError(picture.string() + ": the number in the name gives no time; a times.txt is expected");
      stamps.add(nanoseconds(after_s),
                 [&](const std::string& what) { throw ConfigError(picture.string() + ": " + what); });
      times_ns[number] = stamps.all_ns().back();
    }
    return times_ns;
  }
  TextRows rows(file.string(), ' ');
  while (rows.next()) {
    const double s = rows.number(0);
    if (rows.cells().size() != 1 || !(s >= 0.0 && s <= kMaxSeconds)) rows.fail("one time in seconds is expected");
    stamps.add(nanoseconds(s), [&](const std::string& what) { rows.fail(what); });
  }
  stamps.interval_ns(file.string());
  const std::int64_t first = first_number(file, stamps.all_ns().size(), pictures);
  for (const auto& [number, picture] : pictures)
    times_ns[number] = stamps.all_ns()[static_cast<size_t>(number - first)];
  return times_ns;
}

// Image number to pose; rows with NaN are skipped.
std::map<std::int64_t, Eigen::Isometry3d> read_truth(const fs::path& file, const Pictures& pictures,
                                                     std::map<std::string, int>& skipped) {
  TextRows rows(file.string(), ' ');
  std::vector<std::optional<Eigen::Isometry3d>> poses;
  while (rows.next()) {
    const Matrix34d m = matrix(rows, 0);
    poses.emplace_back();
    if (!m.allFinite()) continue;
    const Eigen::Matrix3d R = m.leftCols<3>();
    if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-2 || R.determinant() < 0.0)
      rows.fail("the left 3 x 3 of the matrix is not a rotation");
    // Seven digits only: re-orthonormalise.
    poses.back() = make_pose(Eigen::Quaterniond(R).normalized().toRotationMatrix(), m.col(3));
  }
  std::map<std::int64_t, Eigen::Isometry3d> truth;
  if (poses.empty()) return truth;
  const std::int64_t first = first_number(file, poses.size(), pictures);
  for (const auto& [number, picture] : pictures) {
    if (const auto& pose = poses[static_cast<size_t>(number - first)])
      truth[number] = *pose;
    else
      ++skipped[kNoNumbers];
  }
  return truth;
}

// The odometry data set keeps the poses of sequences/NN in poses/NN.txt.
fs::path truth_file(const fs::path& root, const std::string& name) {
  const fs::path beside = root / ".." / ".." / "poses" / (name + ".txt");
  return fs::exists(root / "poses.txt") || !fs::exists(beside) ? root / "poses.txt" : beside;
}

}  // namespace

StereoDataSet read_kitti(const std::string& dir, const std::string& poses, double rate_hz) {
  const fs::path root(dir);
  StereoDataSet set;
  set.layout = "KITTI";
  set.name = fs::absolute(root).lexically_normal().filename().string();
  set.rig = rig_from(root / "calib.txt");
  set.rig.T_body_left = T_body_left_camera();
  const Pictures left = numbered_pictures(first_folder(root, {"image_0", "image_l"}), set.skipped);
  Pictures right = numbered_pictures(first_folder(root, {"image_1", "image_r"}), set.skipped);
  const auto times_ns = read_times(root / "times.txt", left, rate_hz);
  const fs::path pose_file = poses.empty() ? truth_file(root, set.name) : fs::path(poses);
  std::map<std::int64_t, Eigen::Isometry3d> truth;
  if (!poses.empty() || fs::exists(pose_file)) truth = read_truth(pose_file, left, set.skipped);
  std::optional<std::int64_t> first_ns;
  for (const auto& [number, picture] : left) {
    const auto partner = right.extract(number);
    if (partner.empty()) {
      ++set.skipped[kWithoutPartner];
      continue;
    }
    if (!first_ns) first_ns = times_ns.at(number);
    StereoPair pair{(times_ns.at(number) - *first_ns) / 1000, picture.string(), partner.mapped().string(),
                    std::nullopt};
    if (const auto pose = truth.find(number); pose != truth.end())
      pair.T_map_body = T_body_left_camera() * pose->second * T_body_left_camera().inverse();
    set.pairs.push_back(std::move(pair));
  }
  set.skipped[kWithoutPartner] += static_cast<int>(right.size());
  return set;
}

}  // namespace rover::interchange
