#include "point_cloud/rims.hpp"

#include <vector>

namespace rover::cloud {
namespace {

// One column of pixels, from the far side of jumps to the near one.
class Column {
 public:
  explicit Column(const RimConfig& config)
      : jump_(16.0 * config.jump_px), steep_(16.0 * config.steep_px_per_px), width_(config.width_px) {}

  // True where the next row's pixel belongs to a rim.
  bool takes(int v, int px16) {
    if (px16 <= 0) return false;
    if (above_ > 0 && px16 - above_ > jump_ + steep_ * (v - above_at_)) end_ = v + width_;
    above_ = px16;
    above_at_ = v;
    return v < end_;
  }

 private:
  double jump_;
  double steep_;
  int width_;
  int above_ = 0;     // the last disparity [1/16 px] ...
  int above_at_ = 0;  // ... and its row
  int end_ = 0;
};

}  // namespace

void take_rims(Disparity& disparity, const RimConfig& config) {
  std::vector<Column> columns(static_cast<size_t>(disparity.width), Column(config));
  for (int v = 0; v < disparity.height; ++v)
    for (int u = 0; u < disparity.width; ++u)
      if (columns[static_cast<size_t>(u)].takes(v, disparity.at(u, v))) disparity.at(u, v) = Disparity::kInvalid;
}

}  // namespace rover::cloud
