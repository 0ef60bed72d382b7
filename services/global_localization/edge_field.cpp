#include "global_localization/edge_field.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rover::global {
namespace {

float median_square(const PlaneField& field) {
  std::vector<float> squares;
  for (size_t i = 0; i < field.known.size(); ++i)
    if (field.known[i] != 0) squares.push_back(field.gx[i] * field.gx[i] + field.gy[i] * field.gy[i]);
  if (squares.empty()) return 0.0F;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle;
}

}  // namespace

PlaneField edge_field(PlaneField brightness) {
  const float usual = median_square(brightness);
  for (size_t i = 0; i < brightness.known.size(); ++i) {
    const float gx = brightness.gx[i], gy = brightness.gy[i];
    const float sum = gx * gx + gy * gy + usual;
    brightness.gx[i] = sum > 0.0F ? (gx * gx - gy * gy) / sum : 0.0F;
    brightness.gy[i] = sum > 0.0F ? 2.0F * gx * gy / sum : 0.0F;
  }
  return brightness;
}

}  // namespace rover::global
