#include "tools/interchange/import_data_set.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <rover/ground_command_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/bus/yaml_file.hpp"
#include "common/core/frames.hpp"
#include "tools/interchange/picture_file.hpp"
#include "tools/interchange/stereo_data_set.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

constexpr Utime kFirstTick = 1'000'000;
constexpr Utime kStartPose = 1'060'000;  // after the start of localization
constexpr Utime kFirstPair = 1'200'000;
constexpr Utime kAfterLast = 1'000'000;  // time for outputs of the last pair
constexpr size_t kMaxMessageBytes = 500'000;

// Log of the data set, in the order in which the recorder would have written it.
class LogWriter {
 public:
  explicit LogWriter(const std::string& path) : path_(path), log_(path, "w"), streams_("import", 1) {
    if (!log_.good()) throw ConfigError(path_ + ": cannot be written");
  }
  template <class Message>
  void write(const char* channel, Message message, Utime utime) {
    message.header = streams_.next(channel, utime, utime);
    std::vector<std::uint8_t> bytes = encoded(message);
    lcm::LogEvent event{};
    event.timestamp = utime;
    event.channel = channel;
    event.data = bytes.data();
    event.datalen = static_cast<std::int32_t>(bytes.size());
    if (log_.writeEvent(&event) != 0) fail();
  }
  // Buffered data may not fit on the disk.
  void finish() {
    if (std::fflush(log_.getFilePtr()) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const { throw ConfigError(path_ + ": cannot be written: " + std::strerror(errno)); }

  std::string path_;
  lcm::LogFile log_;
  StreamCounter streams_;
};

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

image_t image_message(const std::string& file, const StereoRig& rig) {
  const GrayImage image = read_picture(file);
  if (image.width != rig.width || image.height != rig.height)
    throw ConfigError(file + ": " + size_text(image.width, image.height) + " px, the first picture has " +
                      size_text(rig.width, rig.height));
  image_t message{};
  image_to(image, message);
  return message;
}

truth_t truth_message(const Eigen::Isometry3d& T_map_body) {
  truth_t truth{};
  pose_to(T_map_body, truth.position_map_body_m, truth.quat_map_body_wxyz);
  truth.clearance_m = kInfinity;
  return truth;
}

ground_command_t start_command(const Eigen::Isometry3d& T_map_body) {
  ground_command_t command{};
  command.command_id = 1;
  command.kind = ground_command_t::SET_START_POSE;
  Eigen::Map<Eigen::Vector3d>(command.position_map_m) = T_map_body.translation();
  command.yaw_rad = yaw_of(T_map_body);
  command.sigma_m = 0.01;
  command.sigma_yaw_rad = to_rad(0.05);
  command.clear_radius_m = 1.0;
  return command;
}

// Increments over the tick that ends at t: the mean of its readings. Empty without one.
std::optional<imu_t> imu_message(const std::vector<ImuReading>& imu, Utime t) {
  const auto later = [](Utime time, const ImuReading& reading) { return time < kFirstPair + reading.since_first; };
  const auto end = std::upper_bound(imu.begin(), imu.end(), t, later);
  const auto begin = std::upper_bound(imu.begin(), end, t - kTickUs, later);
  if (begin == end) return std::nullopt;
  imu_t message{};
  message.dt_s = to_seconds(kTickUs);
  const double share_s = message.dt_s / static_cast<double>(end - begin);
  for (auto reading = begin; reading != end; ++reading) {
    Eigen::Map<Eigen::Vector3d>(message.delta_angle_rad) += share_s * reading->rate_radps;
    Eigen::Map<Eigen::Vector3d>(message.delta_velocity_mps) += share_s * reading->force_mps2;
  }
  message.fog_delta_yaw_rad = kNaN;
  message.status = imu_t::OK;
  return message;
}

void write_log(const StereoDataSet& set, const std::string& path, const std::string& name) {
  LogWriter log(path);
  const Utime last = kFirstPair + set.pairs.back().since_first + kAfterLast;
  auto pair = set.pairs.begin();
  for (Utime t = kFirstTick; t <= last; t += kTickUs) {
    if (!keep_running()) throw Interrupted("interrupted; removed " + name);
    if (t == kStartPose)
      log.write(channel::kGroundCommand,
                start_command(set.pairs.front().T_map_body.value_or(Eigen::Isometry3d::Identity())), t);
    for (; pair != set.pairs.end() && kFirstPair + pair->since_first <= t; ++pair) {
      const Utime exposure = kFirstPair + pair->since_first;
      log.write(channel::kLocCamLeft, image_message(pair->left, set.rig), exposure);
      log.write(channel::kLocCamRight, image_message(pair->right, set.rig), exposure);
      if (pair->T_map_body) log.write(channel::kTruth, truth_message(*pair->T_map_body), exposure);
    }
    if (const auto imu = imu_message(set.imu, t)) log.write(channel::kImu, *imu, t);
    tick_t tick{};
    tick.mode = tick_t::LOCKSTEP;
    tick.member_count = tick.stream_count = 0;
    log.write(channel::kTick, tick, t);
  }
  log.finish();
}

void change_yaml(const fs::path& file, const std::function<void(YAML::Node&)>& change) {
  YAML::Node root = load_yaml(file.string());
  change(root);
  write_yaml(file, root);
}

YAML::Node camera_node(const PinholeCamera& camera) {
  YAML::Node node;
  node["fx_px"] = camera.fx_px;
  node["fy_px"] = camera.fy_px;
  node["cx_px"] = camera.cx_px;
  node["cy_px"] = camera.cy_px;
  const size_t count = camera.model == DistortionModel::kRadTan ? 5 : 4;
  for (size_t i = 0; i < count; ++i) node["distortion"].push_back(camera.distortion[i]);
  node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

YAML::Node rig_node(const StereoRig& rig) {
  YAML::Node node;
  node["width_px"] = rig.width;
  node["height_px"] = rig.height;
  node["distortion_model"] = name_of(rig.left.model);
  node["left"] = camera_node(rig.left);
  node["right"] = camera_node(rig.right);
  const Eigen::Vector3d rpy = rpy_of(rig.T_left_right.linear());
  for (int i = 0; i < 3; ++i) {
    node["right_in_left"]["position_m"].push_back(rig.T_left_right.translation()(i));
    node["right_in_left"]["rpy_deg"].push_back(to_deg(rpy(i)));
    node["left_in_body"]["position_m"].push_back(0.0);
  }
  const Eigen::Vector3d mount = rpy_of(rig.T_body_left.linear() * T_body_left_camera().linear().transpose());
  // Gimbal lock: roll and yaw are not separable.
  if (!(rotation_from_rpy(mount.x(), mount.y(), mount.z()) * T_body_left_camera().linear())
           .isApprox(rig.T_body_left.linear(), 1e-6))
    throw ConfigError("the left camera looks straight up or down at the first pair: its mounting has no angles");
  node["left_in_body"]["roll_deg"] = to_deg(mount.x());
  node["left_in_body"]["pitch_down_deg"] = to_deg(mount.y());
  node["left_in_body"]["yaw_deg"] = to_deg(mount.z());
  return node;
}

// The modelled computer keeps up with the images: each pair counts in an evaluation.
double latency_for_each_pair_s(const StereoDataSet& set) {
  Utime shortest = to_utime(0.1);
  for (size_t i = 1; i < set.pairs.size(); ++i)
    shortest = std::min(shortest, set.pairs[i].since_first - set.pairs[i - 1].since_first);
  return to_seconds(std::max<Utime>(1, shortest / kTickUs) * kTickUs);
}

// Project configuration for the data set's cameras, without ground plane, wheels and the rover's speed limit. An IMU
// predicts rotations for visual odometry only: localization would need a standstill to learn its biases.
void write_configuration(const ImportOptions& options, const StereoDataSet& set, const fs::path& dir) {
  fs::create_directory(dir);
  for (const auto& entry : fs::directory_iterator(options.config_dir))
    if (entry.path().extension() == ".yaml") fs::copy_file(entry.path(), dir / entry.path().filename());
  change_yaml(dir / "cameras.yaml", [&](YAML::Node& cameras) { cameras["loccam"] = rig_node(set.rig); });
  const double latency_s = latency_for_each_pair_s(set);
  change_yaml(dir / "stereo.yaml", [&](YAML::Node& stereo) {
    stereo["latency_s"] = latency_s;
    stereo["ground_reference"] = false;
    stereo["matcher"]["residual_min_px"] = 0;
    stereo["matcher"]["residual_count_px"] = options.max_disparity_px;
  });
  change_yaml(dir / "visual_odometry.yaml", [&](YAML::Node& odometry) {
    odometry["latency_s"] = latency_s;
    odometry["stereo"]["max_disparity_px"] = static_cast<double>(options.max_disparity_px);
    // Per pair, and pairs may be metres apart.
    odometry["odometry"]["max_position_sigma_m"] = 0.2;
  });
  change_yaml(dir / "localization.yaml", [&](YAML::Node& localization) {
    localization["max_speed_mps"] = options.max_speed_mps;
    localization["camera_only"]["enabled"] = true;
    localization["smoothing_s"] = 0.02;
    localization["filter"]["no_gyro_noise_rad_rts"] = 10.0;  // rotation is known from images only
    localization["status"]["max_dead_reckoned_m"] = 100.0;
  });
}

void write_facts(const StereoDataSet& set, const fs::path& file) {
  const nlohmann::json facts = {{"scenario", set.name},
                                {"data_set", {{"layout", set.layout}, {"pairs", set.pairs.size()}}}};
  std::ofstream out(file);
  out << facts.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  out.close();
  if (!out) throw ConfigError(file.string() + ": cannot be written");
}

void check_principal_point(const PinholeCamera& camera, const StereoRig& rig, const std::string& picture) {
  const auto in_the_middle = [](double at, int size) { return at > 0.25 * size && at < 0.75 * size; };
  if (!in_the_middle(camera.cx_px, rig.width) || !in_the_middle(camera.cy_px, rig.height))
    throw ConfigError(picture + ": " + size_text(rig.width, rig.height) +
                      " px, but the calibration has its principal point at " + std::to_string(camera.cx_px) + ", " +
                      std::to_string(camera.cy_px) + ": is it for another image size?");
}

void set_size(StereoDataSet& set) {
  const std::string& file = set.pairs.front().left;
  const GrayImage first = read_picture(file);
  StereoRig& rig = set.rig;
  if (rig.width != 0 && (rig.width != first.width || rig.height != first.height))
    throw ConfigError(file + ": " + size_text(first.width, first.height) +
                      " px, but the calibration is for images of " + size_text(rig.width, rig.height));
  rig.width = first.width;
  rig.height = first.height;
  if (first.data.size() > kMaxMessageBytes)
    throw ConfigError(file + ": " + std::to_string(first.data.size()) + " px, a message holds at most " +
                      std::to_string(kMaxMessageBytes) + ": scale the images and the calibration down");
  check_principal_point(rig.left, rig, file);
  check_principal_point(rig.right, rig, file);
}

// Checks before writing.
void check_space(const StereoDataSet& set, const fs::path& dir) {
  constexpr std::uintmax_t kTickBytes = 150;
  const auto ticks = static_cast<std::uintmax_t>((set.pairs.back().since_first + kFirstPair + kAfterLast) / kTickUs);
  const std::uintmax_t bytes =
      2 * set.pairs.size() * static_cast<size_t>(set.rig.width) * set.rig.height + ticks * kTickBytes;
  const std::uintmax_t available = fs::space(dir).available;
  if (bytes > available)
    throw ConfigError(dir.parent_path().string() + ": the log needs " + std::to_string(bytes >> 20) +
                      " MB, but the free space is " + std::to_string(available >> 20) + " MB");
}

std::vector<std::string> summary(const StereoDataSet& set, const std::string& out) {
  const auto with_truth = std::count_if(set.pairs.begin(), set.pairs.end(),
                                        [](const StereoPair& pair) { return pair.T_map_body.has_value(); });
  std::vector<std::string> lines = {set.layout + ": " + std::to_string(set.pairs.size()) + " stereo pairs of " +
                                    size_text(set.rig.width, set.rig.height) + " px, " + std::to_string(with_truth) +
                                    " with ground truth"};
  for (const auto& [what, count] : set.skipped)
    if (count > 0) lines.push_back("skipped: " + std::to_string(count) + " " + what);
  const auto too_fast = [](const StereoPair& a, const StereoPair& b) {
    return b.since_first - a.since_first < kTickUs;
  };
  if (std::adjacent_find(set.pairs.begin(), set.pairs.end(), too_fast) != set.pairs.end())
    lines.push_back("note: pairs less than 20 ms apart: of those in one tick the services take the newest");
  for (const std::string& note : set.notes) lines.push_back("note: " + note);
  if (!set.imu.empty())
    lines.push_back("IMU: " + std::to_string(set.imu.size()) + " readings, to predict rotations for visual odometry");
  lines.push_back("imported: " + out);
  lines.push_back("next: ./rover replay " + out + " --services stereo,visual_odometry,localization --speed max");
  return lines;
}

}  // namespace

std::vector<std::string> import_data_set(const ImportOptions& options) {
  if (options.max_disparity_px < 16 || options.max_disparity_px > 512 || options.max_disparity_px % 16 != 0)
    throw ConfigError("--max-disparity: a multiple of 16 up to 512 is expected");
  NewFolder out(options.out);
  StereoDataSet set = read_stereo_data_set(options.data_set, options.poses, options.rate_hz);
  set_size(set);
  check_space(set, out.dir());
  try {
    write_configuration(options, set, out.dir() / "config");
    write_log(set, (out.dir() / "traverse.lcm").string(), options.out);
    write_facts(set, out.dir() / "run.json");
  } catch (const fs::filesystem_error& failure) {
    throw ConfigError(failure.path1().string() + ": " + failure.code().message());
  }
  out.keep();
  return summary(set, options.out);
}

}  // namespace rover::interchange
