#include "common/bus/child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include "common/bus/config.hpp"

namespace rover {
namespace {

constexpr int kNotStarted = 127;
constexpr int kSignalBase = 128;
constexpr double kEndPollS = 0.02;
constexpr double kEndS = 20.0;

[[noreturn]] void become(const std::vector<char*>& arguments, const char* log_file, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(kNotStarted);  // it ended before the request
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(log_file, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (in < 0 || out < 0) _exit(kNotStarted);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  execvp(arguments[0], arguments.data());
  _exit(kNotStarted);
}

}  // namespace

Child::Child(const std::vector<std::string>& command, const std::string& log_file) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) throw ConfigError(command.front() + ": cannot be started: " + std::strerror(errno));
  if (pid_ == 0) become(arguments, log_file.c_str(), parent);
  setpgid(pid_, pid_);  // whoever of the two is first
}

Child::~Child() {
  end(kEndS);
}

bool Child::running() {
  if (ended_) return false;
  int status = 0;
  const pid_t ended = waitpid(pid_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return true;
  ended_ = true;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : kSignalBase + WTERMSIG(status);
  return false;
}

void Child::end(double grace_s) {
  if (!running()) return;
  kill(pid_, SIGTERM);
  for (double waited_s = 0.0; running() && waited_s < grace_s; waited_s += kEndPollS) sleep_s(kEndPollS);
  if (!running()) return;
  kill(-pid_, SIGKILL);
  while (running()) sleep_s(kEndPollS);
}

std::string status_text(int status) {
  if (status == kNotStarted) return "could not be started";
  if (status > kSignalBase && status < kSignalBase + NSIG)
    return "killed by signal " + std::to_string(status - kSignalBase);
  return "exit status " + std::to_string(status);
}

std::string last_line(const std::string& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return one_line(last);
}

void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

}  // namespace rover
