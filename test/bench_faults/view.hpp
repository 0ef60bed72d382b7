// Ideal disparity image of flat ground with rocks: constant ground disparities with ray-cast rocks.
#pragma once

#include <vector>

#include "common/core/image.hpp"
#include "test/bench_faults/field.hpp"

namespace rover::bench_faults {

class View {
 public:
  // `ground_z_m`: ground height in body axes.
  View(const StereoCamera& camera, double ground_z_m);

  // Rocks in body axes. `share`: fraction of valid pixels.
  Disparity look(const std::vector<Rock>& rocks, double share) const;
  const StereoCamera& camera() const { return camera_; }

 private:
  void draw(const Rock& rock, Disparity& disparity) const;

  StereoCamera camera_;
  double ground_z_m_;
  Disparity ground_;
};

}  // namespace rover::bench_faults
