// Writes all bus messages to the run's traverse.lcm. It reports DONE like every node, so it never falls behind.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <rover/injection_t.hpp>
#include <string>

#include "common/bus/node.hpp"
#include "recorder/config.hpp"
#include "recorder/convert.hpp"
#include "recorder/log_file.hpp"

namespace rover::recorder {

class RecorderNode {
 public:
  using FreeBytes = std::function<std::uintmax_t()>;

  // Throws ConfigError if disk space is too low or the log cannot be written.
  RecorderNode(Node& node, const RecorderConfig& config, const std::string& log_path, FreeBytes free_bytes);
  ~RecorderNode();
  RecorderNode(const RecorderNode&) = delete;
  RecorderNode& operator=(const RecorderNode&) = delete;

 private:
  void add(const RawMessage& raw);
  void step(Utime now);
  void write(const std::vector<Event>& events);
  void open_log();
  void retry_recording(Utime now);
  void check_disk(Utime now);
  double free_gb(Utime now) const;
  void stop_recording(const std::string& why);

  Node& node_;
  RecorderConfig config_;
  std::string log_path_;
  FreeBytes free_bytes_;
  KeepPolicy policy_;
  TriggerFinder triggers_;
  EventBuffer buffer_;
  std::unique_ptr<LogFile> log_;  // null: recording stopped
  Utime stopped_at_ = kNever;
  Utime disk_checked_ = kNever;
  std::optional<injection_t> injected_full_disk_;  // an injected fault
};

std::shared_ptr<RecorderNode> make_recorder(Node& node, const std::string& config_dir);

}  // namespace rover::recorder
