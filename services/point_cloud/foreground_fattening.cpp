#include "point_cloud/foreground_fattening.hpp"

#include <vector>

namespace rover::cloud {
namespace {

// Scans one image column from top (far) to bottom (near).
class Column {
 public:
  explicit Column(const FatteningConfig& config)
      : min_jump_(16.0 * config.min_jump_px), slope_(16.0 * config.slope_px_per_px), width_(config.width_px) {}

  // True if this pixel is on the near side of a jump, within the width.
  bool is_fattened(int v, int px16) {
    if (px16 <= 0) return false;
    if (previous_ > 0 && px16 - previous_ > min_jump_ + slope_ * (v - previous_row_)) fattened_until_row_ = v + width_;
    previous_ = px16;
    previous_row_ = v;
    return v < fattened_until_row_;
  }

 private:
  double min_jump_;
  double slope_;
  int width_;
  int previous_ = 0;      // last valid disparity [1/16 px]
  int previous_row_ = 0;  // and its row
  int fattened_until_row_ = 0;
};

}  // namespace

void remove_foreground_fattening(Disparity& disparity, const FatteningConfig& config) {
  std::vector<Column> columns(static_cast<size_t>(disparity.width), Column(config));
  for (int v = 0; v < disparity.height; ++v)
    for (int u = 0; u < disparity.width; ++u)
      if (columns[static_cast<size_t>(u)].is_fattened(v, disparity.at(u, v))) disparity.at(u, v) = Disparity::kInvalid;
}

}  // namespace rover::cloud
