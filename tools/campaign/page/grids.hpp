// Panels of a campaign as pictures: success, and the small multiples of each figure.
#pragma once

#include <vector>

#include "tools/campaign/page/grid_picture.hpp"
#include "tools/campaign/page/panels.hpp"
#include "tools/campaign/page/results.hpp"

namespace rover::campaign {

// Title, axes and labels of a panel; no tiles.
GridPicture empty_picture(const Panels& panels, const Panel& panel);

// Per tile: success of the feasible drives, their number, Wilson's interval, infeasible ones; contacts raise an alarm.
std::vector<GridPicture> success_pictures(const Panels& panels, const Drives& drives);

// Per tile: median and worst drive. Colours run from the best to the worst median of all panels.
struct FigurePictures {
  std::vector<GridPicture> pictures;
  double best;  // medians at the ends of the colours; NaN without values
  double worst;
};
FigurePictures figure_pictures(const Panels& panels, const Drives& drives, const ShownFigure& figure);

}  // namespace rover::campaign
