#include "common/geo/undeclared_voids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

namespace rover {
namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();
constexpr double kPossibleStepM = 50.0;       // highest vertical cliffs that elevation models resolve
constexpr double kPossibleStepPixels = 10.0;  // 84 deg
constexpr double kWallFraction = 0.8;         // of a void's border; interpolated pixels there hide some of it
constexpr double kLargeFraction = 0.01;       // of the map
constexpr float kFarApartM = 1000.0F;
constexpr double kMinPixelM = 0.25;  // below it, noise between neighbours looks steep
constexpr size_t kSteps = 1'000'000;

// Calls f(pixel, neighbour) for each pair of 4-neighbours.
template <class F>
void for_neighbours(const ElevationRaster& raster, F&& f) {
  const size_t width = raster.width;
  for (size_t i = 0; i < raster.z_m.size(); ++i) {
    if ((i + 1) % width != 0) f(i, i + 1);
    if (i + width < raster.z_m.size()) f(i, i + width);
  }
}

template <class F>
void for_neighbours_of(const ElevationRaster& raster, size_t i, F&& f) {
  const size_t width = raster.width;
  if (i % width != 0) f(i - 1);
  if ((i + 1) % width != 0) f(i + 1);
  if (i >= width) f(i - width);
  if (i + width < raster.z_m.size()) f(i + width);
}

// NaN without neighbours.
double median_step_m(const ElevationRaster& raster) {
  const size_t stride = raster.z_m.size() / kSteps + 1;
  std::vector<float> steps;
  for (size_t i = 0; i + 1 < raster.z_m.size(); i += stride)
    if (const float step = std::abs(raster.z_m[i + 1] - raster.z_m[i]);
        (i + 1) % static_cast<size_t>(raster.width) != 0 && std::isfinite(step))
      steps.push_back(step);
  if (steps.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

class Search {
 public:
  Search(ElevationRaster& raster, double pixel_m)
      : raster_(raster),
        z_(raster.z_m),
        possible_step_m_(static_cast<float>(std::max(kPossibleStepM, kPossibleStepPixels * pixel_m))) {}

  bool has_walls() const {
    bool found = false;
    for_neighbours(raster_, [&](size_t a, size_t b) { found = found || is_wall(a, b); });
    return found;
  }

  void remove_plateaus(UndeclaredVoids& found) {
    const auto borders = borders_of_plateaus();
    std::unordered_map<float, std::int64_t> voids;
    for (const auto& [height, border] : borders)
      if (border.is_void()) voids[height] = 0;
    for (float& z : z_)
      if (const auto entry = voids.find(z); entry != voids.end()) ++entry->second, z = kVoid;
    for (const auto& [height, pixels] : voids) found.plateaus.push_back({height, pixels});
    std::sort(found.plateaus.begin(), found.plateaus.end(),
              [](const auto& a, const auto& b) { return a.height_m < b.height_m; });
  }

  void remove_interpolated(UndeclaredVoids& found) {
    const std::vector<int> region = label();
    if (regions_.empty()) return;
    mark_walls(region);
    const auto ground = std::max_element(regions_.begin(), regions_.end(),
                                         [](const Region& a, const Region& b) { return a.pixels < b.pixels; });
    std::int64_t finite = 0;
    for (const Region& r : regions_) finite += r.pixels;
    for (Region& r : regions_) {
      if (&r == &*ground || !r.at_wall) continue;
      r.is_interpolated = static_cast<double>(r.pixels) < kLargeFraction * static_cast<double>(finite);
      if (!r.is_interpolated && r.distance_m(*ground) > kFarApartM) found.problem = conflict(*ground, r);
    }
    for (size_t i = 0; i < z_.size(); ++i)
      if (region[i] >= 0 && regions_[region[i]].is_interpolated) ++found.interpolated, z_[i] = kVoid;
  }

 private:
  // Border of all plateaus of one height.
  struct Border {
    std::int64_t walls = 0, others = 0;
    float beyond = kVoid;  // height across the first wall
    bool varies = false;   // several heights across: a void in terrain, not two adjacent plateaus
    bool is_void() const {
      return varies && static_cast<double>(walls) >= kWallFraction * static_cast<double>(walls + others);
    }
  };
  struct Region {
    std::uint32_t first = 0;
    std::uint32_t pixels = 0;
    float low = 0.0F, high = 0.0F;
    bool at_wall = false, is_interpolated = false;
    float distance_m(const Region& other) const { return std::max(low - other.high, other.low - high); }
  };

  // False if one is NaN.
  bool is_wall(size_t a, size_t b) const { return std::abs(z_[a] - z_[b]) > possible_step_m_; }

  bool is_in_plateau(size_t i) const {
    bool equal = false;
    for_neighbours_of(raster_, i, [&](size_t n) { equal = equal || z_[n] == z_[i]; });
    return equal;
  }

  std::unordered_map<float, Border> borders_of_plateaus() const {
    std::unordered_map<float, Border> borders;
    const auto add_wall = [&](size_t a, size_t b) {
      if (!is_in_plateau(a)) return;
      Border& border = borders[z_[a]];
      if (border.walls++ == 0) border.beyond = z_[b];
      border.varies = border.varies || z_[b] != border.beyond;
    };
    for_neighbours(raster_, [&](size_t a, size_t b) {
      if (is_wall(a, b)) add_wall(a, b), add_wall(b, a);
    });
    for_neighbours(raster_, [&](size_t a, size_t b) {
      if (z_[a] == z_[b] || is_wall(a, b) || std::isnan(z_[a]) || std::isnan(z_[b])) return;
      for (const size_t i : {a, b})
        if (const auto entry = borders.find(z_[i]); entry != borders.end()) ++entry->second.others;
    });
    return borders;
  }

  // Region number of each pixel, connected by possible steps; -1 for voids.
  std::vector<int> label() {
    std::vector<int> region(z_.size(), -1);
    std::vector<std::uint32_t> open;
    for (size_t i = 0; i < z_.size(); ++i) {
      if (region[i] >= 0 || std::isnan(z_[i])) continue;
      const int number = static_cast<int>(regions_.size());
      regions_.push_back({static_cast<std::uint32_t>(i), 0, z_[i], z_[i]});
      region[i] = number;
      open.push_back(static_cast<std::uint32_t>(i));
      while (!open.empty()) {
        const size_t at = open.back();
        open.pop_back();
        Region& r = regions_.back();
        ++r.pixels, r.low = std::min(r.low, z_[at]), r.high = std::max(r.high, z_[at]);
        for_neighbours_of(raster_, at, [&](size_t n) {
          if (region[n] >= 0 || std::isnan(z_[n]) || is_wall(at, n)) return;
          region[n] = number;
          open.push_back(static_cast<std::uint32_t>(n));
        });
      }
    }
    return region;
  }

  void mark_walls(const std::vector<int>& region) {
    for_neighbours(raster_, [&](size_t a, size_t b) {
      if (is_wall(a, b)) regions_[region[a]].at_wall = regions_[region[b]].at_wall = true;
    });
  }

  std::string place(const Region& r) const {
    const auto row = static_cast<int>(r.first / static_cast<size_t>(raster_.width));
    return std::to_string(std::lround(r.low)) + " to " + std::to_string(std::lround(r.high)) + " m (" +
           std::to_string(r.pixels) + " pixels, one at column " +
           std::to_string(r.first % static_cast<size_t>(raster_.width)) + ", line " +
           std::to_string(raster_.height - 1 - row) + ")";
  }
  std::string conflict(const Region& a, const Region& b) const {
    return "heights of " + place(a) + " and of " + place(b) +
           " are adjacent, and one of them is not ground; declare its height with gdal_edit.py -a_nodata";
  }

  const ElevationRaster& raster_;
  std::vector<float>& z_;
  float possible_step_m_;
  std::vector<Region> regions_;
};

}  // namespace

UndeclaredVoids remove_undeclared_voids(ElevationRaster& raster, double pixel_m) {
  UndeclaredVoids found;
  if (median_step_m(raster) > std::max(pixel_m, kMinPixelM)) {
    found.problem =
        "half of its neighbouring pixels are steeper than 45 deg, as in a picture; a map of heights is expected";
    return found;
  }
  Search search(raster, pixel_m);
  if (!search.has_walls()) return found;
  search.remove_plateaus(found);
  search.remove_interpolated(found);
  return found;
}

}  // namespace rover
