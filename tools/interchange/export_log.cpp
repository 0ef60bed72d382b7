#include "tools/interchange/export_log.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <rover/path_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/log_runs.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/user_files.hpp"
#include "common/geo/elevation_map_file.hpp"
#include "common/geo/geography.hpp"
#include "tools/interchange/csv_table.hpp"
#include "tools/interchange/foxglove.hpp"
#include "tools/interchange/mcap_writer.hpp"
#include "tools/interchange/message_json.hpp"
#include "tools/interchange/tracks.hpp"
#include "tools/status/text_line.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

constexpr double kTrackStepM = 0.05;

void require_written(const std::ofstream& file, const fs::path& path) {
  if (!file) throw ConfigError(path.string() + ": cannot be written; is the disk full?");
}

std::ofstream open_file(const fs::path& path) {
  std::ofstream file(path, std::ios::binary);
  require_written(file, path);
  return file;
}

void close_file(std::ofstream& file, const fs::path& path) {
  file.close();
  require_written(file, path);
}

template <class Message>
std::optional<Message> decoded(const LogEvent& event) {
  Message message{};
  if (!decode_message(event.data, event.size, message)) return std::nullopt;
  return message;
}

class CsvExport {
 public:
  explicit CsvExport(fs::path dir) : dir_(std::move(dir)) { fs::create_directory(dir_); }

  void add(const LogEvent& event, const Fields& fields) {
    Table& table = tables_[event.channel];
    if (table.columns.empty()) {
      table.columns = csv_columns(find_channel_type(event.channel)->name);
      table.file = open_file(file_of(event.channel));
      write_csv_header(table.file, table.columns);
    }
    write_csv_row(table.file, table.columns, fields);
    require_written(table.file, file_of(event.channel));
  }
  void finish() {
    for (auto& [channel, table] : tables_) close_file(table.file, file_of(channel));
  }

 private:
  struct Table {
    std::vector<std::string> columns;
    std::ofstream file;
  };
  // Only known channels have fields, so a channel name in a log cannot lead out of the folder.
  fs::path file_of(const std::string& channel) const { return dir_ / (channel + ".csv"); }

  fs::path dir_;
  std::map<std::string, Table> tables_;
};

class McapExport {
 public:
  explicit McapExport(const fs::path& file) : writer_(file.string()) {}

  void add(const LogEvent& event, const header_t& header, const Fields& fields) {
    const std::string type = find_channel_type(event.channel)->name;
    if (type == "image_t") {
      if (const auto image = decoded<image_t>(event))
        write("/" + event.channel, foxglove::kCompressedImage, header,
              foxglove::compressed_image(*image, event.channel));
      return;
    }
    if (type == "disparity_t") {
      if (const auto disparity = decoded<disparity_t>(event))
        write("/" + event.channel, foxglove::kRawImage, header, foxglove::raw_image(*disparity, event.channel));
      return;
    }
    write("/" + event.channel, type, header, json_text(fields));
    if (event.channel != channel::kPose) return;
    if (const auto pose = decoded<pose_t>(event))
      write("/tf", foxglove::kFrameTransforms, header, foxglove::frame_transforms(*pose));
  }
  void finish() { writer_.finish(); }

 private:
  void write(const std::string& topic, const std::string& schema, const header_t& header, const std::string& data) {
    if (data.empty()) return;
    auto it = channels_.find(topic);
    if (it == channels_.end()) {
      const bool is_foxglove = schema.rfind("foxglove.", 0) == 0;
      const std::string text = is_foxglove ? foxglove::schema(schema) : json_schema(schema);
      it = channels_.emplace(topic, writer_.add_channel(topic, is_foxglove ? schema : "rover." + schema, text)).first;
    }
    const auto ns = [](Utime utime) { return static_cast<std::uint64_t>(std::max<Utime>(utime, 0)) * 1000; };
    writer_.write(it->second, static_cast<std::uint32_t>(header.seq), ns(header.release_utime), ns(header.utime), data);
  }

  McapWriter writer_;
  std::map<std::string, std::uint16_t> channels_;
};

class TrackExport {
 public:
  void add(const LogEvent& event) {
    if (event.channel == channel::kTruth) {
      if (const auto m = decoded<truth_t>(event))
        add(tracks_.truth, m->header.utime, pose_from(m->position_map_body_m, m->quat_map_body_wxyz));
    } else if (event.channel == channel::kPose) {
      const auto m = decoded<pose_t>(event);
      if (!m) return;
      const Eigen::Isometry3d T_odom_body = pose_from(m->position_odom_body_m, m->quat_odom_body_wxyz);
      add(tracks_.odometry, m->header.utime, T_odom_body);
      add(tracks_.estimate, m->header.utime, pose_from(m->position_map_odom_m, m->quat_map_odom_wxyz) * T_odom_body);
    } else if (event.channel == channel::kGlobalPath) {
      if (const auto m = decoded<path_t>(event)) add_path(*m);
    }
  }
  const Tracks& tracks() const { return tracks_; }

 private:
  static void add(Trajectory& trajectory, Utime utime, const Eigen::Isometry3d& T) {
    if (is_finite(T)) trajectory.push_back({utime, T});
  }
  // A path may be repeated.
  void add_path(const path_t& message) {
    const auto same = [&](const Path& path) { return path.id == message.path_id; };
    if (std::any_of(tracks_.global_paths.begin(), tracks_.global_paths.end(), same)) return;
    Path path{message.path_id, message.header.utime, {}};
    for (size_t i = 0; i < message.x_m.size(); ++i) path.points.emplace_back(message.x_m[i], message.y_m[i]);
    tracks_.global_paths.push_back(std::move(path));
  }

  Tracks tracks_;
};

// Geographic coordinates by the run's orbital map, if it is georeferenced.
ToLonLat planet_of(const fs::path& log) {
  const fs::path map = log.parent_path() / "orbital_map.tif";
  if (!fs::exists(map)) return {};
  try {
    const auto geography = std::make_shared<Geography>(ElevationMapFile(map.string()).frame());
    if (!geography->is_known()) return {};
    return [geography](const Eigen::Vector2d& p) { return geography->to_lon_lat(p); };
  } catch (const std::exception&) {  // no projection: use metres
    return {};
  }
}

size_t time_falls(const Trajectory& trajectory) {
  size_t falls = 0;
  for (size_t i = 1; i < trajectory.size(); ++i) falls += trajectory[i].utime < trajectory[i - 1].utime ? 1 : 0;
  return falls;
}

void write_trajectories(const fs::path& dir, const Tracks& tracks, std::vector<std::string>& lines) {
  fs::create_directory(dir);
  for (const auto& [name, trajectory] : {std::pair{"truth", &tracks.truth}, std::pair{"estimate", &tracks.estimate},
                                         std::pair{"odometry", &tracks.odometry}}) {
    if (trajectory->empty()) {
      lines.push_back(std::string("tum/") + name + ".txt: not written, the log has no such poses");
      continue;
    }
    const fs::path path = dir / (std::string(name) + ".txt");
    std::ofstream file = open_file(path);
    write_tum(file, *trajectory);
    close_file(file, path);
    if (const size_t falls = time_falls(*trajectory); falls > 0)
      lines.push_back(std::string("tum/") + name + ".txt: time decreases at " + std::to_string(falls) +
                      " of its lines; without TICK the runs of the log cannot be separated");
  }
}

// Skipped messages by channel.
class LeftOut {
 public:
  void add(const std::string& channel) { ++(find_channel_type(channel) == nullptr ? foreign_ : damaged_)[channel]; }
  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (const auto& [channel, count] : damaged_)
      lines.push_back(channel + ": " + std::to_string(count) + " messages do not decode; skipped");
    if (!foreign_.empty()) lines.push_back(foreign_line());
    return lines;
  }

 private:
  std::string foreign_line() const {
    constexpr size_t kMost = 5;
    std::int64_t count = 0;
    std::string names;
    size_t named = 0;
    for (const auto& [channel, messages] : foreign_) {
      count += messages;
      if (++named <= kMost) names += (named == 1 ? "" : ", ") + status::printable(channel);
    }
    return std::to_string(count) + " messages on unknown channels; skipped: " + names +
           (foreign_.size() > kMost ? " ..." : "");
  }

  std::map<std::string, std::int64_t> damaged_;
  std::map<std::string, std::int64_t> foreign_;
};

// Exporters that run while the log is read.
struct Exports {
  std::optional<CsvExport> csv;
  std::optional<McapExport> mcap;
  TrackExport tracks;
  LeftOut skipped;
  std::int64_t taken = 0;

  void add(const LogEvent& event) {
    header_t header{};
    const auto fields = decode_fields(event.channel, event.data, event.size);
    if (!fields || !peek_header(event.data, event.size, header)) return skipped.add(event.channel);
    ++taken;
    if (csv) csv->add(event, *fields);
    if (mcap) mcap->add(event, header, *fields);
    tracks.add(event);
  }
  void finish() {
    if (csv) csv->finish();
    if (mcap) mcap->finish();
  }
};

std::vector<std::string> write_all(const ExportOptions& options, const LogRun& run, const fs::path& dir) {
  const auto wants = [&](const char* format) { return options.formats.contains(format); };
  Exports exports;
  if (wants("csv")) exports.csv.emplace(dir / "csv");
  if (wants("mcap")) exports.mcap.emplace(dir / "traverse.mcap");
  for_each_event(run, [&](const LogEvent& event) {
    if (!keep_running()) throw ConfigError("./rover export: interrupted; nothing is kept");
    if (options.channels.empty() || options.channels.contains(event.channel)) exports.add(event);
  });
  if (exports.taken == 0)
    throw ConfigError(run.log + ": contains no messages of a rover" +
                      (options.channels.empty() ? "" : " on the requested channels"));
  exports.finish();
  std::vector<std::string> lines = remarks(run);
  if (wants("tum")) write_trajectories(dir / "tum", exports.tracks.tracks(), lines);
  if (wants("geojson")) {
    std::ofstream file = open_file(dir / "tracks.geojson");
    file << geojson(exports.tracks.tracks(), planet_of(run.log), kTrackStepM);
    close_file(file, dir / "tracks.geojson");
  }
  for (std::string& line : exports.skipped.lines()) lines.push_back(std::move(line));
  lines.push_back(std::to_string(exports.taken) + " messages");
  return lines;
}

// Default: beside the log.
fs::path target_of(const ExportOptions& options, const fs::path& log) {
  if (!options.out.empty()) return options.out;
  const fs::path dir = log.parent_path();
  return fs::is_directory(options.log) ? dir / "export" : dir / (log.stem().string() + "_export");
}

}  // namespace

std::vector<std::string> export_log(const ExportOptions& options) {
  for (const std::string& format : options.formats)
    if (!kExportFormats.contains(format))
      throw ConfigError("--format: no format '" + format + "'; known formats: csv, geojson, mcap, tum");
  for (const std::string& channel : options.channels)
    if (find_channel_type(channel) == nullptr) throw ConfigError("--channels: no channel '" + channel + "'");
  const LogRun run = choose_run(options.log, options.log_run);
  const fs::path target = target_of(options, run.log);
  NewFolder out(target.string());
  try {
    std::vector<std::string> lines = write_all(options, run, out.dir());
    out.keep();
    lines.push_back("exported: " + target.string());
    return lines;
  } catch (const ConfigError&) {
    throw;
  } catch (const std::exception& failure) {  // file system error
    throw ConfigError(failure.what());
  }
}

}  // namespace rover::interchange
