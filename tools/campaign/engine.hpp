// What runs the jobs of a campaign: an existing program, behind three functions.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace rover::campaign {

struct Batch {
  std::vector<int> jobs;
  std::vector<std::string> command;  // of a job; its number is the last argument
  std::string work;                  // folder for the engine's own files, on a disk that all workers see
  std::string log;                   // file for what the engine and the workers say
  int parallel_jobs = 0;             // at the same time; 0: the engine's default
  std::string sshloginfile;          // GNU parallel: other machines; empty: this one
  int cores_per_job = 1;             // Slurm
};

class Engine {
 public:
  virtual ~Engine() = default;
  // Begins all jobs of the batch; the batch before must have ended.
  virtual void start(const Batch& batch) = 0;
  // False when no job is running or waiting. Throws ConfigError with one line if the engine itself fails.
  virtual bool running() = 0;
  // Ends all jobs, and returns when they have ended.
  virtual void stop() = 0;
};

// Names of the engines, the default first.
std::vector<std::string> engine_names();
// Throws ConfigError with one line and the Debian package if its program is not installed.
std::unique_ptr<Engine> make_engine(const std::string& name);

// Ends jobs that an engine has left in `work` when its campaign was killed.
void end_left_jobs(const std::string& work);

}  // namespace rover::campaign
