#include "recorder/repair.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"
#include "recorder/log_file.hpp"
#include "status/running_run.hpp"

namespace rover::recorder {
namespace {

namespace fs = std::filesystem;

// Neighbouring records, as one piece of the file.
struct Piece {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

struct Scan {
  std::string path;
  std::vector<Piece> pieces;
  LogLength length;
  bool whole() const { return length.left_bytes == 0; }
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
  if (in && out) return;
  std::error_code error;
  fs::remove(to, error);
  throw ConfigError(to + ": cannot be written");
}

void check_target(const Scan& damaged, const std::string& to) {
  if (fs::exists(to)) throw ConfigError(to + ": exists already; remove it, or name another with --out");
  const fs::path folder = fs::absolute(to).parent_path();
  if (!fs::is_directory(folder)) throw ConfigError(folder.string() + ": no such folder");
  const std::uintmax_t free_bytes = free_disk_bytes(folder);
  if (free_bytes < static_cast<std::uintmax_t>(damaged.kept_bytes()))
    throw ConfigError(fmt::format("{}: {:.2f} GB free on the disk, {:.2f} GB are needed", folder.string(),
                                  static_cast<double>(free_bytes) * 1e-9,
                                  static_cast<double>(damaged.kept_bytes()) * 1e-9));
}

// Where the whole log is written to; in place it takes the damaged one's name afterwards.
std::string target_of(const Scan& part, const RepairArguments& arguments) {
  if (arguments.in_place) return part.path + ".new";
  return arguments.out.empty() ? repaired_name(part.path) : arguments.out;
}

void check(const std::vector<Scan>& scans, const RepairArguments& arguments) {
  for (const Scan& part : scans) {
    if (part.pieces.empty()) throw ConfigError(part.path + ": holds no whole record; is it an LCM log?");
    if (!part.whole()) check_target(part, target_of(part, arguments));
  }
  if (!arguments.out.empty() && scans.size() > 1)
    throw ConfigError(arguments.out + ": the log has " + std::to_string(scans.size()) +
                      " parts; without --out each is written beside the damaged one");
  const fs::path folder = fs::absolute(scans.front().path).parent_path();
  if (arguments.in_place && status::is_running(folder))
    throw ConfigError(folder.string() + ": the run still records; stop it first");
}

std::string repair_part(const Scan& part, const RepairArguments& arguments) {
  if (part.whole()) return fmt::format("{}: whole, {} messages; nothing to do", part.path, part.length.records);
  std::string to = target_of(part, arguments);
  copy_pieces(part, to);
  if (arguments.in_place) {
    fs::rename(to, part.path);
    to = part.path;
  }
  return fmt::format("{}: {} messages kept, {} bytes at {} place{} left out", to, part.length.records,
                     part.length.left_bytes, part.length.damages, part.length.damages == 1 ? "" : "s");
}

}  // namespace

void repair(const RepairArguments& arguments) {
  const std::string log = fs::is_directory(arguments.log) ? arguments.log + "/traverse.lcm" : arguments.log;
  std::vector<Scan> scans;
  for (const std::string& part : log_parts(log)) scans.push_back(scan(part));
  check(scans, arguments);
  for (const Scan& part : scans) std::printf("%s\n", repair_part(part, arguments).c_str());
}

}  // namespace rover::recorder
