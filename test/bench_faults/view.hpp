// What ideal stereo sees of flat ground with rocks: the ground's disparities are always the same, rocks are cast into
// it.
#pragma once

#include <vector>

#include "common/core/image.hpp"
#include "test/bench_faults/field.hpp"

namespace rover::bench_faults {

class View {
 public:
  // `ground_z_m`: of the ground in body axes.
  View(const StereoCamera& camera, double ground_z_m);

  // Rocks in body axes. `share`: of the pixels that are measured.
  Disparity look(const std::vector<Rock>& rocks, double share) const;
  const StereoCamera& camera() const { return camera_; }

 private:
  void draw(const Rock& rock, Disparity& disparity) const;

  StereoCamera camera_;
  double ground_z_m_;
  Disparity ground_;
};

}  // namespace rover::bench_faults
