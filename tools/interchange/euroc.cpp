#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/decimal.hpp"
#include "common/core/frames.hpp"
#include "tools/calibration/lens_model.hpp"
#include "tools/interchange/stamps.hpp"
#include "tools/interchange/stereo_data_set.hpp"
#include "tools/interchange/text_rows.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxGapNs = 100'000'000;  // maximum interval for interpolation of the ground truth

struct Listed {
  std::int64_t time_ns = 0;
  fs::path picture;
};

std::int64_t time_of(const TextRows& rows) {
  const std::string_view time = rows.cells().front();
  const auto ns = parse_whole_number(time);
  if (!ns || *ns < 0) rows.fail("'" + std::string(time.substr(0, 40)) + "' is not a time in nanoseconds");
  return *ns;
}

struct PictureList {
  std::vector<Listed> pictures;
  std::int64_t interval_ns = 0;
};

// data.csv of a camera: time [ns] and image name.
PictureList read_pictures(const fs::path& camera) {
  const std::string file = (camera / "data.csv").string();
  TextRows rows(file, ',');
  PictureList list;
  Stamps stamps;
  while (rows.next()) {
    if (rows.cells().size() < 2 || rows.cells()[1].empty()) rows.fail("no name of a picture after the time");
    stamps.add(time_of(rows), [&](const std::string& what) { rows.fail(what); });
    list.pictures.push_back({stamps.all_ns().back(), camera / "data" / rows.cells()[1]});
  }
  list.interval_ns = stamps.interval_ns(file);
  return list;
}

Eigen::Isometry3d read_T_BS(const Config& sensor) {
  const Config T_BS = sensor.section("T_BS");
  const std::vector<double> values = T_BS.numbers("data", {-1e3, 1e3}, 16);
  Eigen::Isometry3d T;
  for (int i = 0; i < 16; ++i) T.matrix()(i / 4, i % 4) = values[static_cast<size_t>(i)];
  if (!(T.linear() * T.linear().transpose()).isIdentity(1e-3) || T.linear().determinant() < 0.0)
    T_BS.fail("data", "is not a rigid motion");
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return T;
}

struct Camera {
  PinholeCamera pinhole;
  Eigen::Isometry3d T_body_camera;
};

Camera read_camera(const fs::path& file, StereoRig& rig) {
  const Config sensor = Config::load(file.string());
  sensor.one_of("camera_model", {"pinhole"});
  const auto f = sensor.numbers("intrinsics", {0, 1e5}, 4);
  if (f[0] < 10.0 || f[1] < 10.0) sensor.fail("intrinsics", "a focal length in pixels is at least 10");
  Camera camera{{f[0], f[1], f[2], f[3], {}}, read_T_BS(sensor)};
  const std::string problem = calibration::set_lens(camera.pinhole, sensor.text("distortion_model"),
                                                    sensor.numbers("distortion_coefficients", {-10, 10}, 0));
  if (!problem.empty()) sensor.fail("distortion_model", problem);
  if (sensor.has("resolution")) {
    const auto size = sensor.numbers("resolution", {16, 8192}, 2);
    rig.width = static_cast<int>(size[0]);
    rig.height = static_cast<int>(size[1]);
  }
  return camera;
}

void read_cameras(const fs::path& root, StereoDataSet& set) {
  const fs::path right_file = root / "cam1" / "sensor.yaml";
  const Camera left = read_camera(root / "cam0" / "sensor.yaml", set.rig);
  const Camera right = read_camera(right_file, set.rig);
  set.rig.left = left.pinhole;
  set.rig.right = right.pinhole;
  if (left.pinhole.model != right.pinhole.model)
    throw ConfigError(right_file.string() + ": distortion_model: another one than that of cam0");
  set.rig.T_left_right = left.T_body_camera.inverse() * right.T_body_camera;
  set.rig.T_body_left = left.T_body_camera;
  const std::string problem = problem_of_pair(set.rig.T_left_right);
  if (!problem.empty()) throw ConfigError(right_file.string() + ": T_BS: " + problem);
}

struct TruthRow {
  std::int64_t time_ns;
  Eigen::Isometry3d T_world_body;
};

// Columns have a fixed order; a header with another order is refused or followed.
void check_head(const TextRows& rows) {
  const auto& names = rows.head();
  if (names.size() >= 8 && names[4].find('w') == std::string_view::npos)
    rows.fail("the columns time, x, y, z, qw, qx, qy, qz are expected, in this order");
}

std::vector<TruthRow> read_truth(const fs::path& dir, std::map<std::string, int>& skipped) {
  std::vector<TruthRow> truth;
  if (!fs::exists(dir / "data.csv")) return truth;
  TextRows rows((dir / "data.csv").string(), ',');
  while (rows.next()) {
    check_head(rows);
    if (rows.cells().size() < 8) rows.fail("too few columns; time, x, y, z, qw, qx, qy, qz are expected");
    const std::int64_t time_ns = time_of(rows);
    if (!truth.empty() && time_ns <= truth.back().time_ns) rows.fail("times do not increase");
    Eigen::Matrix<double, 7, 1> v;
    for (int i = 0; i < 7; ++i) v[i] = rows.number(static_cast<size_t>(i) + 1);
    if (!v.allFinite()) {
      ++skipped[kNoNumbers];
      continue;
    }
    const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1.0) > 1e-2) rows.fail("qw, qx, qy, qz are not a unit quaternion");
    truth.push_back({time_ns, make_pose(q.normalized().toRotationMatrix(), v.head<3>())});
  }
  return truth;
}

std::optional<Eigen::Isometry3d> truth_at(const std::vector<TruthRow>& truth, std::int64_t time_ns) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), time_ns,
                                      [](const TruthRow& row, std::int64_t t) { return row.time_ns < t; });
  if (after == truth.end()) return std::nullopt;
  if (after->time_ns == time_ns) return after->T_world_body;
  if (after == truth.begin() || after->time_ns - std::prev(after)->time_ns > kMaxGapNs) return std::nullopt;
  const auto before = std::prev(after);
  const double u =
      static_cast<double>(time_ns - before->time_ns) / static_cast<double>(after->time_ns - before->time_ns);
  return interpolate(before->T_world_body, after->T_world_body, u);
}

// Pairs images with nearly equal times.
std::int64_t max_gap_ns(const PictureList& lefts) {
  return std::min<std::int64_t>(1'000'000, lefts.interval_ns / 20);
}

void pair_up(const PictureList& lefts, const PictureList& rights, StereoDataSet& set,
             std::vector<std::int64_t>& times_ns) {
  const std::int64_t max_ns = max_gap_ns(lefts);
  std::int64_t widest_ns = 0;
  auto right = rights.pictures.begin();
  for (const Listed& left : lefts.pictures) {
    while (right != rights.pictures.end() && right->time_ns < left.time_ns - max_ns)
      ++right, ++set.skipped[kWithoutPartner];
    if (right == rights.pictures.end() || right->time_ns > left.time_ns + max_ns) {
      ++set.skipped[kWithoutPartner];
      continue;
    }
    const Listed& partner = *right++;
    if (!fs::exists(left.picture) || !fs::exists(partner.picture)) {
      ++set.skipped["pairs with a missing image file"];
      continue;
    }
    widest_ns = std::max(widest_ns, std::abs(partner.time_ns - left.time_ns));
    times_ns.push_back(left.time_ns);
    set.pairs.push_back(
        {(left.time_ns - times_ns.front()) / 1000, left.picture.string(), partner.picture.string(), {}});
  }
  set.skipped[kWithoutPartner] += static_cast<int>(rights.pictures.end() - right);
  if (widest_ns > 0)
    set.notes.push_back("the two images of a pair are up to " + std::to_string((widest_ns + 999) / 1000) + " us apart");
}

void add_truth(const fs::path& dir, const std::vector<std::int64_t>& times_ns, StereoDataSet& set) {
  const std::vector<TruthRow> truth = read_truth(dir, set.skipped);
  const Eigen::Isometry3d T_sensors_body = set.rig.T_body_left * T_body_left_camera().inverse();
  bool any = false;
  for (size_t i = 0; i < set.pairs.size(); ++i)
    if (const auto T_world_sensors = truth_at(truth, times_ns[i])) {
      set.pairs[i].T_map_body = *T_world_sensors * T_sensors_body;
      any = true;
    }
  if (!truth.empty() && !set.pairs.empty() && !any)
    throw ConfigError((dir / "data.csv").string() + ": from " + std::to_string(truth.front().time_ns) + " to " +
                      std::to_string(truth.back().time_ns) +
                      " ns, no image is within the time of the ground truth; the images begin at " +
                      std::to_string(times_ns.front()) + " ns");
}

// Gyro and accelerometer, turned into body axes.
void add_imu(const fs::path& dir, std::int64_t first_ns, StereoDataSet& set) {
  if (!fs::exists(dir / "data.csv")) return;
  const Eigen::Isometry3d T_sensors_body = set.rig.T_body_left * T_body_left_camera().inverse();
  const Eigen::Matrix3d R_body_imu =
      T_sensors_body.linear().transpose() * read_T_BS(Config::load((dir / "sensor.yaml").string())).linear();
  TextRows rows((dir / "data.csv").string(), ',');
  while (rows.next()) {
    if (rows.cells().size() < 7) rows.fail("too few columns; time, three rates and three accelerations are expected");
    const Utime since_first = (time_of(rows) - first_ns) / 1000;
    if (!set.imu.empty() && since_first <= set.imu.back().since_first) rows.fail("times do not increase");
    Eigen::Matrix<double, 6, 1> v;
    for (int i = 0; i < 6; ++i) v[i] = rows.number(static_cast<size_t>(i) + 1);
    if (v.allFinite())
      set.imu.push_back({since_first, R_body_imu * v.head<3>(), R_body_imu * v.tail<3>()});
    else
      ++set.skipped["IMU readings that are not a number"];
  }
  if (!set.imu.empty() &&
      (set.imu.back().since_first < 0 || set.imu.front().since_first > set.pairs.back().since_first))
    throw ConfigError((dir / "data.csv").string() + ": no reading is within the time of the images");
}

}  // namespace

StereoDataSet read_euroc(const std::string& dir) {
  const fs::path root = fs::is_directory(fs::path(dir) / "mav0") ? fs::path(dir) / "mav0" : fs::path(dir);
  StereoDataSet set;
  set.layout = "EuRoC";
  set.name = fs::absolute(dir).lexically_normal().filename().string();
  read_cameras(root, set);
  std::vector<std::int64_t> times_ns;
  const PictureList lefts = read_pictures(root / "cam0");
  pair_up(lefts, read_pictures(root / "cam1"), set, times_ns);
  add_truth(root / "state_groundtruth_estimate0", times_ns, set);
  if (!times_ns.empty()) add_imu(root / "imu0", times_ns.front(), set);
  set.rig.T_body_left = T_body_left_camera();
  return set;
}

}  // namespace rover::interchange
