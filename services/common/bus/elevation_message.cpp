#include "common/bus/elevation_message.hpp"

namespace rover {
namespace {

constexpr int kMaxCells = 1000;  // along a side
constexpr double kMaxPlaceM = 1e6;

bool in_range(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

std::string fault_of(const elevation_t& message) {
  if (!in_range(message.cells_x, 3, kMaxCells) || !in_range(message.cells_y, 3, kMaxCells)) return "size out of range";
  const std::size_t size = static_cast<std::size_t>(message.cells_x) * static_cast<std::size_t>(message.cells_y);
  if (message.height_m.size() != size || message.sigma_m.size() != size) return "size contradicts the cells";
  if (!message.brightness.empty() && message.brightness.size() != size)
    return "its brightness does not belong to its cells";
  if (!in_range(message.cell_m, 0.02, 1.0)) return "side of a cell is not usable";
  if (!in_range(message.origin_x_m, -kMaxPlaceM, kMaxPlaceM) || !in_range(message.origin_y_m, -kMaxPlaceM, kMaxPlaceM))
    return "origin is not usable";
  return "";
}

}  // namespace rover
