// One start of a campaign: a folder in which it and its workers meet. The next session renames it before it reads it,
// so a worker that is still running can write no row then.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/store.hpp"

namespace rover::campaign {

class Session {
 public:
  // Adds to the store what earlier sessions have left, ends their jobs, and begins a new session.
  static Session begin(const std::string& dir, Store& store);
  // What a worker is given.
  explicit Session(std::string work) : work_(std::move(work)) {}

  const std::string& work() const { return work_; }
  bool is_open() const;
  // Both work on a full disk too, where new files cannot be made.
  void close() const;
  void close_for_full_disk() const;
  bool found_full_disk() const;
  // Of a worker that cannot go on; nobody else could.
  void close_because(const std::string& reason) const;
  std::string reason_to_close() const;

  // Moves the rows that workers have written to the store.
  void collect(Store& store) const;

  void note_start(int job, int attempt) const;
  bool has_started(int job, int attempt) const;
  void note_death(int job, const std::string& reason) const;
  std::string reason_of_death(int job) const;
  void write_row(int job, const Row& row) const;
  // New, for one attempt of a job.
  std::string run_dir(int job, int attempt) const;

  // At the end of the campaign; with what is left of earlier sessions, whose rows are in the store.
  void remove() const;

 private:
  std::string work_;
};

}  // namespace rover::campaign
