// The drives of a campaign, as DIR/jobs.jsonl lists them: job N is line N, from 1.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/row.hpp"

namespace rover::campaign {

struct Job {
  Cell cell;
  std::int64_t seed = 0;
  std::string scenario;          // variant of the base, relative to DIR: scenarios/....yaml
  std::string level;             // empty: the scenario's own
  std::string perception;        // empty: the default
  std::vector<std::string> set;  // file.key=value
};

// Its images are rendered, by several processes.
bool is_rendered(const Job& job);

// Throws ConfigError with one line.
std::vector<Job> read_jobs(const std::string& dir);
// Number `number`, without reading those after it.
Job read_job(const std::string& dir, int number);
void write_jobs(const std::string& dir, const std::vector<Job>& jobs);

// In single quotes where a shell would change it.
std::string shell_word(const std::string& word);

// Arguments of ./rover for this drive: run SCENARIO --seed ... --level ... --perception ... --set ...
std::vector<std::string> drive_arguments(const std::string& dir, const Job& job);
// The command that repeats the drive with full recording, for a shell: ./rover run ... --record full
std::string repeat_command(const std::string& dir, const Job& job);

}  // namespace rover::campaign
