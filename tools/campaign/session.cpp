#include "tools/campaign/session.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"
#include "tools/campaign/engine.hpp"
#include "tools/campaign/folder.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;

std::string attempt_name(int job, int attempt) {
  return std::to_string(job) + "-" + std::to_string(attempt);
}

// Of a file that is being written: two machines may repeat a job at the same time.
std::string unfinished_tag(int attempt) {
  return "." + std::to_string(attempt) + "-" + std::to_string(getpid()) + ".new";
}

std::string first_line(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

constexpr size_t kMaxRow = 1 << 20;
constexpr size_t kRowsAtOnce = 2000;
const std::string kOpen = "work-", kClosed = "closed-";

std::vector<fs::path> folders_named(const std::string& dir, const std::string& prefix) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(dir))
    if (entry.is_directory() && entry.path().filename().string().starts_with(prefix)) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  return folders;
}

void end_sessions(const std::string& dir) {
  for (const fs::path& work : folders_named(dir, kOpen)) {
    Session(work).close();
    end_left_jobs(work);
    fs::rename(work, fs::path(dir) / (kClosed + work.filename().string().substr(kOpen.size())));
  }
}

// Finished rows only: while one is written its name ends in .new.
std::vector<fs::path> row_files(const std::string& work) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(work + "/rows", error))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Session Session::begin(const std::string& dir, Store& store) try {
  end_sessions(dir);
  std::error_code ignored;  // a killed drive may still be writing; the next session tries again
  for (const fs::path& closed : folders_named(dir, kClosed)) {
    Session(closed).collect(store);
    fs::remove_all(closed, ignored);
  }
  std::string work = dir + "/" + kOpen + "XXXXXX";
  if (mkdtemp(work.data()) == nullptr) throw ConfigError(dir + ": cannot be written: " + std::strerror(errno));
  fs::permissions(work, fs::perms(0755));
  for (const char* folder : {"rows", "started", "died", "runs"}) fs::create_directory(work + "/" + folder);
  write_file(work + "/open", "");
  return Session(work);
} catch (const fs::filesystem_error& error) {
  throw ConfigError(dir + ": cannot be written: " + error.code().message());
}

bool Session::is_open() const {
  return access((work_ + "/open").c_str(), F_OK) == 0;
}

void Session::close() const {
  unlink((work_ + "/open").c_str());
}

void Session::close_for_full_disk() const {
  rename((work_ + "/open").c_str(), (work_ + "/full").c_str());
}

bool Session::found_full_disk() const {
  return access((work_ + "/full").c_str(), F_OK) == 0;
}

void Session::close_because(const std::string& reason) const {
  try {
    write_file(work_ + "/reason", reason + "\n", unfinished_tag(0));
  } catch (const ConfigError&) {  // a full disk
  }
  close();
}

std::string Session::reason_to_close() const {
  return first_line(work_ + "/reason");
}

void Session::collect(Store& store) const {
  const std::vector<fs::path> files = row_files(work_);
  for (size_t first = 0; first < files.size(); first += kRowsAtOnce) {
    const size_t last = std::min(files.size(), first + kRowsAtOnce);
    std::vector<Row> rows;
    for (size_t i = first; i < last; ++i) rows.push_back(parse_row(read_text(files[i], kMaxRow), files[i]));
    store.add(rows);
    // A kill before this adds the rows again, and the store keeps those that it has.
    for (size_t i = first; i < last; ++i) unlink(files[i].c_str());
  }
}

void Session::note_start(int job, int attempt) const {
  write_file(work_ + "/started/" + attempt_name(job, attempt), "");
}

bool Session::has_started(int job, int attempt) const {
  return fs::exists(work_ + "/started/" + attempt_name(job, attempt));
}

void Session::note_death(int job, const std::string& reason) const {
  write_file(work_ + "/died/" + std::to_string(job), reason + "\n", unfinished_tag(0));
}

std::string Session::reason_of_death(int job) const {
  const std::string reason = first_line(work_ + "/died/" + std::to_string(job));
  return reason.empty() ? "the worker was killed" : reason;
}

void Session::write_row(int job, const Row& row) const {
  write_file(work_ + "/rows/" + std::to_string(job) + ".json", json_line(row) + "\n", unfinished_tag(row.attempts));
}

std::string Session::run_dir(int job, int attempt) const {
  return work_ + "/runs/" + attempt_name(job, attempt);
}

void Session::remove() const {
  std::error_code ignored;
  for (const fs::path& closed : folders_named(fs::path(work_).parent_path(), kClosed)) fs::remove_all(closed, ignored);
  fs::remove_all(work_, ignored);
}

}  // namespace rover::campaign
