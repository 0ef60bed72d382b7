// Exhaustive search for correlation peaks over every cell and yaw step of the search window.
#pragma once

#include <vector>

#include "global_localization/terrain_match.hpp"

namespace rover::global {

struct SearchWindow {
  CandidatePose prior;
  double half_width_m = 12.0;
  double half_width_rad = 0.2;
  double yaw_step_rad = 0.03;  // approximate
  double min_overlap = 0.8;    // fraction of the template's samples with orbital data
  int max_samples = 0;         // of the template, spread over it, are compared; 0: all
};

struct Peak {
  CandidatePose pose;
  double score = -1.0;  // correlation
};

// Non-maximum suppression: by decreasing score, each further than `min_distance_m` from any higher peak.
std::vector<Peak> find_peaks(const OrbitalSection& orbital, const TerrainTemplate& terrain, const SearchWindow& window,
                             double min_distance_m, int max_peaks);

}  // namespace rover::global
