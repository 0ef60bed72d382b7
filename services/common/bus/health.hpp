// Resource use of this process and durations of its main step, for heartbeats.
#pragma once

#include <chrono>
#include <vector>

namespace rover {

double process_cpu_s();
double process_rss_mb();

// Durations of the last 256 measured steps.
class StepTimer {
 public:
  void begin() { start_ = std::chrono::steady_clock::now(); }
  void end();
  // Quantile q in [0, 1] in milliseconds; 0 without measurements.
  double quantile_ms(double q) const;

 private:
  std::chrono::steady_clock::time_point start_;
  std::vector<double> ring_ms_;
  size_t next_ = 0;
};

}  // namespace rover
