// A program in a process group of its own that ends with this one, even if this one is killed.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace rover {

class Child {
 public:
  // Its output, errors included, is appended to log_file. Throws ConfigError if no process can be made.
  Child(const std::vector<std::string>& command, const std::string& log_file);
  // Ends it.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool running();
  // SIGTERM; after grace_s SIGKILL to the whole group.
  void end(double grace_s);
  // Of a child that has ended: exit status, or 128 + signal. 127: could not be started.
  int status() const { return status_; }

 private:
  pid_t pid_ = -1;
  int status_ = -1;
  bool ended_ = false;
};

// "exit status 2", "killed by signal 9"
std::string status_text(int status);

// Of a program's output; empty lines do not count.
std::string last_line(const std::string& file);

void sleep_s(double seconds);

}  // namespace rover
