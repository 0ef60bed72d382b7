// Every place of the search window, cell by cell, and every turn: the best correlation at each place, and its peaks.
#pragma once

#include <vector>

#include "global_localization/terrain_match.hpp"

namespace rover::global {

struct SearchWindow {
  Placement prior;
  double reach_m = 12.0;       // to each side
  double reach_rad = 0.2;      // to each side
  double yaw_step_rad = 0.03;  // about
  double min_overlap = 0.8;    // of the template's samples that the orbital map must know
};

struct Peak {
  Placement placement;
  double score = -1.0;  // correlation
};

// Best first, each the highest of its surroundings and further than `apart_m` from any higher one; at most `most`.
std::vector<Peak> find_peaks(const OrbitalPart& orbital, const TerrainTemplate& terrain, const SearchWindow& window,
                             double apart_m, int most);

}  // namespace rover::global
