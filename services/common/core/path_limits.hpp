// Limits of a global path; the planner on board rejects others.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace rover {

constexpr double kShortestPathM = 0.1;
constexpr double kLongestPathM = 1e5;

inline double path_length_m(const std::vector<double>& x_m, const std::vector<double>& y_m) {
  double length_m = 0.0;
  for (size_t i = 1; i < x_m.size(); ++i) length_m += std::hypot(x_m[i] - x_m[i - 1], y_m[i] - y_m[i - 1]);
  return length_m;
}

// Error text; empty if valid.
inline std::string path_length_problem(double length_m) {
  if (length_m < kShortestPathM) return "path is shorter than 0.1 m";
  if (length_m > kLongestPathM) return "path is longer than 100 km";
  return "";
}

}  // namespace rover
