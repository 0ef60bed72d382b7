#include "tools/oracle/local_ground.hpp"

namespace rover::oracle {

double LocalGround::ground_m(int i, int j) {
  Node& node = nodes_.at(i, j);
  if (std::isnan(node.ground_m)) node.ground_m = ground_m_(i * kNodeM, j * kNodeM);
  return node.ground_m;
}

double LocalGround::mean_m(int i, int j) {
  Node& node = nodes_.at(i, j);
  if (!std::isnan(node.mean_m)) return node.mean_m;
  double sum = 0.0;
  for (int dj = -kWindowNodes; dj <= kWindowNodes; ++dj)
    for (int di = -kWindowNodes; di <= kWindowNodes; ++di) sum += ground_m(i + di, j + dj);
  return node.mean_m = sum / ((2 * kWindowNodes + 1) * (2 * kWindowNodes + 1));
}

double LocalGround::at(double x_m, double y_m) {
  const double u = x_m / kNodeM;
  const double v = y_m / kNodeM;
  const int i = static_cast<int>(std::floor(u));
  const int j = static_cast<int>(std::floor(v));
  return std::lerp(std::lerp(mean_m(i, j), mean_m(i + 1, j), u - i),
                   std::lerp(mean_m(i, j + 1), mean_m(i + 1, j + 1), u - i), v - j);
}

}  // namespace rover::oracle
