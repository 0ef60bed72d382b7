#include "common/bus/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>

extern char** environ;

namespace rover {
namespace {

// File redirections of a child process.
class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

pid_t start(const std::vector<std::string>& command, FileActions& files) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t pid = -1;
  return posix_spawnp(&pid, arguments[0], files.get(), nullptr, arguments.data(), environ) == 0 ? pid : -1;
}

int status_of(pid_t pid) {
  if (pid < 0) return -1;
  int status = 0;
  while (waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 1; n != 0;) {
    n = read(file, buffer.data(), buffer.size());
    if (n < 0 && errno != EINTR) break;
    if (n > 0) text.append(buffer.data(), static_cast<size_t>(n));
  }
  return text;
}

}  // namespace

std::optional<std::string> output_of(const std::vector<std::string>& command) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  FileActions files;
  posix_spawn_file_actions_adddup2(files.get(), ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(files.get(), STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  const pid_t pid = start(command, files);
  close(ends[1]);
  std::string text = read_all(ends[0]);
  close(ends[0]);
  if (status_of(pid) != 0) return std::nullopt;
  return text;
}

int run_into(const std::string& log_file, const std::vector<std::string>& command) {
  FileActions files;
  posix_spawn_file_actions_addopen(files.get(), STDOUT_FILENO, log_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  posix_spawn_file_actions_adddup2(files.get(), STDOUT_FILENO, STDERR_FILENO);
  return status_of(start(command, files));
}

int run_program(const std::vector<std::string>& command) {
  FileActions as_here;
  return status_of(start(command, as_here));
}

}  // namespace rover
