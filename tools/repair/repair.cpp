#include "tools/repair/repair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/log_runs.hpp"
#include "common/bus/user_files.hpp"
#include "recorder/log_file.hpp"
#include "tools/status/running_run.hpp"

namespace rover::recorder {
namespace {

namespace fs = std::filesystem;

// Adjacent records as one range of the file.
struct Piece {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

struct Scan {
  std::string path;
  std::vector<Piece> pieces;
  LogLength length;
  bool whole() const { return length.skipped_bytes == 0; }
  std::int64_t kept_bytes() const {
    std::int64_t sum = 0;
    for (const Piece& piece : pieces) sum += piece.end - piece.begin;
    return sum;
  }
};

Scan scan(const std::string& path) {
  Scan out{path, {}, {}};
  EventLogReader reader(path);
  for (LogEvent event; reader.next(event);) {
    if (out.pieces.empty() || out.pieces.back().end != event.begin) out.pieces.push_back({event.begin, event.begin});
    out.pieces.back().end = event.end;
  }
  out.length = reader.length();
  return out;
}

std::string repaired_name(const std::string& path) {
  const fs::path log(path);
  return (log.parent_path() / (log.stem().string() + ".repaired" + log.extension().string())).string();
}

void copy_piece(std::ifstream& in, std::ofstream& out, const Piece& piece) {
  std::array<char, 1 << 16> buffer{};
  in.seekg(piece.begin);
  for (std::int64_t left = piece.end - piece.begin; left > 0 && in && out;) {
    if (!keep_running()) throw ConfigError("./rover repair: interrupted; nothing is kept");
    const auto chunk = std::min<std::int64_t>(left, static_cast<std::int64_t>(buffer.size()));
    in.read(buffer.data(), chunk);
    out.write(buffer.data(), in.gcount());
    left -= in.gcount();
  }
}

void copy_pieces(const Scan& damaged, const std::string& to) {
  std::ifstream in(damaged.path, std::ios::binary);
  std::ofstream out(to, std::ios::binary);
  for (const Piece& piece : damaged.pieces) copy_piece(in, out, piece);
  out.close();
  if (!in) throw ConfigError(damaged.path + ": cannot be read");
  if (!out) throw ConfigError(fs::path(to).parent_path().string() + ": cannot be written; is the disk full?");
}

void check_target(const Scan& damaged, const std::string& to) {
  if (fs::exists(to)) throw ConfigError(to + ": already exists; remove it, or choose another file with --out");
  const fs::path folder = fs::absolute(to).parent_path();
  if (!fs::is_directory(folder)) throw ConfigError(folder.string() + ": no such folder");
  const std::uintmax_t free_bytes = free_disk_bytes(folder);
  if (free_bytes < static_cast<std::uintmax_t>(damaged.kept_bytes()))
    throw ConfigError(fmt::format("{}: {:.2f} GB free on the disk, {:.2f} GB are needed", folder.string(),
                                  static_cast<double>(free_bytes) * 1e-9,
                                  static_cast<double>(damaged.kept_bytes()) * 1e-9));
}

// Output path; with --in-place a temporary file that then replaces the damaged log.
std::string target_of(const Scan& part, const RepairArguments& arguments) {
  if (arguments.in_place) return fs::canonical(part.path).string() + ".new";  // follow a symbolic link
  return arguments.out.empty() ? repaired_name(part.path) : arguments.out;
}

void check(const std::vector<Scan>& scans, const RepairArguments& arguments) {
  const auto has_none = [](const Scan& part) { return part.pieces.empty(); };
  if (std::all_of(scans.begin(), scans.end(), has_none))
    throw ConfigError(scans.front().path + ": contains no intact record; is it an LCM log?");
  for (const Scan& part : scans)
    if (!part.whole() && !has_none(part)) check_target(part, target_of(part, arguments));
  if (!arguments.out.empty() && scans.size() > 1)
    throw ConfigError(arguments.out + ": the log has " + std::to_string(scans.size()) +
                      " parts; without --out each is written beside the damaged part");
  const fs::path folder = fs::absolute(scans.front().path).parent_path();
  if (arguments.in_place && status::is_running(folder))
    throw ConfigError(folder.string() + ": the run is still being recorded; stop it first");
}

std::string repair_part(const Scan& part, const RepairArguments& arguments) {
  if (part.whole()) return fmt::format("{}: intact, {} messages; nothing to do", part.path, part.length.records);
  if (part.pieces.empty()) return fmt::format("{}: contains no intact message; not changed", part.path);
  std::string to = target_of(part, arguments);
  NewFile whole(to);
  copy_pieces(part, whole.path());
  if (arguments.in_place) {
    fs::permissions(whole.path(), fs::status(part.path).permissions());
    fs::rename(whole.path(), fs::canonical(part.path));
    to = part.path;
  } else {
    whole.keep();
  }
  return fmt::format("{}: {} messages kept, {} bytes at {} place{} skipped", to, part.length.records,
                     part.length.skipped_bytes, part.length.damaged_places, part.length.damaged_places == 1 ? "" : "s");
}

}  // namespace

void repair(const RepairArguments& arguments) {
  const std::string log = log_file(arguments.log);
  std::vector<Scan> scans;
  for (const std::string& part : log_parts(log)) scans.push_back(scan(part));
  check(scans, arguments);
  for (const Scan& part : scans) std::printf("%s\n", repair_part(part, arguments).c_str());
  if (const size_t runs = log_runs(log).size(); runs > 1)
    std::printf("%s: contains %zu runs; select one in replay, export, report and spy with --log-run N\n", log.c_str(),
                runs);
}

}  // namespace rover::recorder
