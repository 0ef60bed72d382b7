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

constexpr std::int64_t kMaxGapNs = 100'000'000;  // between two ground-truth poses that a picture may lie between

struct Row {
  std::int64_t time_ns = 0;
  std::vector<std::string> cells;
};

// data.csv: a head that begins with '#', then rows that begin with nanoseconds. Times rise.
std::vector<Row> read_rows(const fs::path& file, size_t least_cells) {
  std::ifstream in(file);
  if (!in) throw ConfigError(file.string() + ": cannot be read");
  std::vector<Row> rows;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const auto fail = [&](const std::string& what) {
      throw ConfigError(file.string() + ":" + std::to_string(number) + ": " + what);
    };
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    Row row;
    std::istringstream cells(line);
    std::string time;
    std::getline(cells, time, ',');
    if (time.empty() || time.size() > 19 || time.find_first_not_of("0123456789") != std::string::npos)
      fail("no time in nanoseconds");
    row.time_ns = std::stoll(time);
    for (std::string cell; std::getline(cells, cell, ',');) row.cells.push_back(cell);
    if (row.cells.size() < least_cells) fail("too few columns");
    if (!rows.empty() && row.time_ns <= rows.back().time_ns) fail("times do not rise");
    rows.push_back(std::move(row));
  }
  return rows;
}

Eigen::Isometry3d read_T_BS(const Config& sensor) {
  const Config T_BS = sensor.section("T_BS");
  const std::vector<double> values = T_BS.numbers("data", {-1e3, 1e3}, 16);
  Eigen::Isometry3d T;
  for (int i = 0; i < 16; ++i) T.matrix()(i / 4, i % 4) = values[static_cast<size_t>(i)];
  if (!(T.linear() * T.linear().transpose()).isIdentity(1e-3) || T.linear().determinant() < 0.0)
    T_BS.fail("data", "is no rigid motion");
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return T;
}

struct Camera {
  PinholeCamera pinhole;
  Eigen::Isometry3d T_body_camera;
};

Camera read_camera(const fs::path& file) {
  const Config sensor = Config::load(file.string());
  sensor.one_of("camera_model", {"pinhole"});
  sensor.one_of("distortion_model", {"radial-tangential", "radtan"});
  const auto f = sensor.numbers("intrinsics", {0, 1e5}, 4);
  const auto d = sensor.numbers("distortion_coefficients", {-10, 10}, 4);
  return {{f[0], f[1], f[2], f[3], {d[0], d[1], d[2], d[3], 0.0}}, read_T_BS(sensor)};
}

struct TruthRow {
  std::int64_t time_ns;
  Eigen::Isometry3d T_world_body;
};

std::vector<TruthRow> read_truth(const fs::path& dir) {
  std::vector<TruthRow> truth;
  if (!fs::exists(dir / "data.csv")) return truth;
  for (const Row& row : read_rows(dir / "data.csv", 7)) {
    double v[7];
    for (size_t i = 0; i < 7; ++i) {
      char* end = nullptr;
      v[i] = std::strtod(row.cells[i].c_str(), &end);
      if (end == row.cells[i].c_str() || !std::isfinite(v[i]))
        throw ConfigError((dir / "data.csv").string() + ": '" + row.cells[i] + "' is no number");
    }
    const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1.0) > 1e-2) throw ConfigError((dir / "data.csv").string() + ": no unit quaternion");
    truth.push_back({row.time_ns, make_pose(q.normalized().toRotationMatrix(), {v[0], v[1], v[2]})});
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

}  // namespace

StereoDataSet read_euroc(const std::string& dir) {
  const fs::path root = fs::is_directory(fs::path(dir) / "mav0") ? fs::path(dir) / "mav0" : fs::path(dir);
  StereoDataSet set;
  set.layout = "EuRoC";
  set.name = fs::absolute(dir).lexically_normal().filename().string();
  const Camera left = read_camera(root / "cam0" / "sensor.yaml");
  const Camera right = read_camera(root / "cam1" / "sensor.yaml");
  set.rig.left = left.pinhole;
  set.rig.right = right.pinhole;
  set.rig.T_left_right = left.T_body_camera.inverse() * right.T_body_camera;
  set.rig.T_body_left = T_body_left_camera();
  const std::vector<TruthRow> truth = read_truth(root / "state_groundtruth_estimate0");
  const std::vector<Row> lefts = read_rows(root / "cam0" / "data.csv", 1);
  const std::vector<Row> rights = read_rows(root / "cam1" / "data.csv", 1);
  const Eigen::Isometry3d T_sensors_body = left.T_body_camera * T_body_left_camera().inverse();
  size_t j = 0;
  std::int64_t first_ns = -1;
  for (const Row& row : lefts) {
    while (j < rights.size() && rights[j].time_ns < row.time_ns) ++j, ++set.unpaired;
    if (j == rights.size() || rights[j].time_ns != row.time_ns) {
      ++set.unpaired;
      continue;
    }
    if (first_ns < 0) first_ns = row.time_ns;
    StereoPair pair{(row.time_ns - first_ns) / 1000, (root / "cam0" / "data" / row.cells[0]).string(),
                    (root / "cam1" / "data" / rights[j++].cells[0]).string(), std::nullopt};
    if (const auto T_world_sensors = truth_at(truth, row.time_ns)) pair.T_map_body = *T_world_sensors * T_sensors_body;
    set.pairs.push_back(std::move(pair));
  }
  return set;
}

}  // namespace rover::interchange
