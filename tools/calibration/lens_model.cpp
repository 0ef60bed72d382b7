#include "tools/calibration/lens_model.hpp"

#include <algorithm>
#include <set>

namespace rover::calibration {
namespace {

const std::set<std::string> kRadTan = {"radtan", "radial-tangential", "plumb_bob", "rational_polynomial", "none"};
const std::set<std::string> kEquidistant = {"equidistant", "fisheye"};

}  // namespace

std::string set_lens(PinholeCamera& camera, const std::string& model, const std::vector<double>& coefficients) {
  const size_t count = coefficients.size();
  if (!kRadTan.contains(model) && !kEquidistant.contains(model))
    return "the model '" + model + "' is not supported; radtan (plumb_bob) and equidistant (fisheye) are";
  if (kEquidistant.contains(model)) {
    if (count != 4) return std::to_string(count) + " coefficients; " + model + " has four: k1 k2 k3 k4";
    camera.model = DistortionModel::kEquidistant;
  } else {
    if (count < 4 && !(count == 0 && model == "none"))
      return std::to_string(count) + " coefficients; four or five are expected: k1 k2 p1 p2 (k3)";
    // OpenCV has up to 14 coefficients.
    if (std::any_of(coefficients.begin() + std::min<std::ptrdiff_t>(5, std::ssize(coefficients)), coefficients.end(),
                    [](double value) { return value != 0.0; }))
      return "the rational model is not supported; calibrate with the five coefficients k1 k2 p1 p2 k3";
    camera.model = DistortionModel::kRadTan;
  }
  camera.distortion.fill(0.0);
  std::copy_n(coefficients.begin(), std::min<size_t>(5, count), camera.distortion.begin());
  return {};
}

}  // namespace rover::calibration
