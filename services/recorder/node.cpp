#include "recorder/node.hpp"

#include <filesystem>

namespace rover::recorder {
namespace {

constexpr double kBytesPerGb = 1e9;
constexpr Utime kCheckPeriod = 1'000'000;
constexpr Utime kRetryPeriod = 10'000'000;  // after recording stopped

}  // namespace

RecorderNode::RecorderNode(Node& node, const RecorderConfig& config, const std::string& log_path, FreeBytes free_bytes)
    : node_(node), config_(config), log_path_(log_path), free_bytes_(std::move(free_bytes)), policy_(config.keep) {
  const double free_gb = static_cast<double>(free_bytes_()) / kBytesPerGb;
  const bool low = free_gb < config_.min_free_start_gb;
  if (low && !std::filesystem::exists(log_path))
    throw ConfigError(
        log_path + ": " + std::to_string(free_gb) +
        " GB of disk space are free, less than min_free_start_gb = " + std::to_string(config_.min_free_start_gb));
  if (low)  // in the middle of a drive, which goes on
    stop_recording("free_gb=" + std::to_string(free_gb));
  else
    open_log();
  node_.subscribe_raw([this](const RawMessage& raw) { add(raw); }, find_channel_type);
  node_.on_injection([this](const injection_t& injection) {
    if (injection.fault == "full_disk") injected_full_disk_ = injection;
  });
  node_.on_step([this](Utime now) { step(now); });
}

void RecorderNode::open_log() {
  log_ = std::make_unique<LogFile>(log_path_, static_cast<std::int64_t>(config_.part_gb * kBytesPerGb));
}

RecorderNode::~RecorderNode() {
  if (!log_) return;
  write(buffer_.pop_all());
  if (log_ && !log_->close()) stop_recording("write failed");
}

void RecorderNode::add(const RawMessage& raw) {
  if (!log_) return;
  if (triggers_.is_trigger(raw)) policy_.trigger(raw.header.release_utime);
  buffer_.add(event_from(raw));
}

void RecorderNode::step(Utime now) {
  if (!log_) return retry_recording(now);
  // In lockstep all messages released before this tick have arrived.
  write(buffer_.pop_before(now - policy_.delay()));
  if (log_ && !log_->flush()) return stop_recording("write failed");
  if (disk_checked_ != kNever && now - disk_checked_ < kCheckPeriod) return;
  disk_checked_ = now;
  check_disk(now);
}

void RecorderNode::write(const std::vector<Event>& events) {
  for (const Event& event : events) {
    if (!log_) return;
    if (policy_.keep(event) && !log_->write(event)) stop_recording("write failed");
  }
}

double RecorderNode::free_gb(Utime now) const {
  if (injected_full_disk_ && now >= injected_full_disk_->from_utime && now <= injected_full_disk_->until_utime)
    return 0.0;
  return static_cast<double>(free_bytes_()) / kBytesPerGb;
}

void RecorderNode::check_disk(Utime now) {
  if (!log_) return;
  const double left_gb = free_gb(now);
  if (left_gb < config_.min_free_gb) stop_recording("free_gb=" + std::to_string(left_gb));
}

// Resumes with a gap when disk space is available again.
void RecorderNode::retry_recording(Utime now) {
  if (now - stopped_at_ < kRetryPeriod || free_gb(now) < config_.min_free_start_gb) return;
  stopped_at_ = now;
  try {
    open_log();
  } catch (const ConfigError&) {
    return;  // still impossible
  }
  node_.set_status(heartbeat_t::OK, "");
  node_.log("WARN", "RECORDING resumed after a gap");
}

void RecorderNode::stop_recording(const std::string& why) {
  log_.reset();
  stopped_at_ = node_.now();
  buffer_.pop_all();
  node_.set_status(heartbeat_t::DEGRADED, "disk full: recording stopped (" + why + ")");
  node_.log("ERROR", "DISK_FULL recording stopped, " + why);
}

std::shared_ptr<RecorderNode> make_recorder(Node& node, const std::string& config_dir) {
  const std::string run_dir = node.options().run_dir;
  if (run_dir.empty()) throw ConfigError("--run-dir is required: the log goes there");
  return std::make_shared<RecorderNode>(node, load_config(config_dir), run_dir + "/traverse.lcm",
                                        [run_dir] { return free_disk_bytes(run_dir); });
}

}  // namespace rover::recorder
