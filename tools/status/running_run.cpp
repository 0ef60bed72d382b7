#include "tools/status/running_run.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

namespace rover::status {
namespace fs = std::filesystem;
namespace {

constexpr int kDepth = 3;  // logs/bench/SUITE/RUN

fs::path scan_dir(const fs::path& run_dir) {
  return run_dir / "services" / ".s6-svscan";
}

struct Newest {
  fs::file_time_type begun = fs::file_time_type::min();
  std::string dir;
};

void search(const fs::path& dir, int depth, Newest& newest) {
  std::error_code error;
  if (fs::exists(dir / "services", error)) {
    const fs::file_time_type begun = fs::last_write_time(scan_dir(dir), error);
    if (!error && begun > newest.begun && is_running(dir)) newest = {begun, dir};
    return;
  }
  if (depth == 0) return;
  for (const auto& entry : fs::directory_iterator(dir, error))
    if (entry.is_directory(error)) search(entry.path(), depth - 1, newest);
}

}  // namespace

// s6-svscan reads its control pipe while it runs; without a reader, opening the pipe for writing fails.
bool is_running(const std::string& run_dir) {
  const int fd = open((scan_dir(run_dir) / "control").c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd >= 0) close(fd);
  return fd >= 0;
}

std::optional<std::string> newest_running(const std::string& logs_dir) {
  Newest newest;
  search(logs_dir, kDepth, newest);
  if (newest.dir.empty()) return std::nullopt;
  return newest.dir;
}

}  // namespace rover::status
