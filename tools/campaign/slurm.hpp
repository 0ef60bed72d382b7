// Slurm: job arrays on a cluster. Partition, account and time limit come from the variables SBATCH_* of sbatch.
#pragma once

#include <chrono>

#include "tools/campaign/engine.hpp"

namespace rover::campaign {

class Slurm : public Engine {
 public:
  void start(const Batch& batch) override;
  bool running() override;
  void stop() override;

  // Ends the jobs of a campaign that was killed.
  static void cancel_left(const std::string& work);

 private:
  void submit();
  bool has_jobs();

  Batch batch_;
  size_t next_ = 0;        // first job that is not submitted
  int arrays_ = 0;         // submitted
  std::string name_;       // of the jobs
  bool has_jobs_ = false;  // when last asked
  std::chrono::steady_clock::time_point asked_;
};

}  // namespace rover::campaign
