#include "tools/report/map_fidelity.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/statistics.hpp"
#include "tools/report/rock_evaluation.hpp"
#include "tools/report/true_relief.hpp"

namespace rover::report {
namespace {

constexpr double kPlaceM = 0.1;      // places fixed in the world
constexpr double kRockStepM = 0.05;  // points of a rock at which the map is read
constexpr double kMaxShiftM = 0.5;   // of a point of a tilted grid by the relief below it
constexpr double kMaxPlaceM = 1e6;   // limit of the map coordinates
constexpr double kMaxRangeM = kFidelityRangesM.back();

template <size_t N>
size_t class_of(double value, const std::array<double, N>& upper_ends) {
  return static_cast<size_t>(std::upper_bound(upper_ends.begin(), upper_ends.end(), value) - upper_ends.begin());
}

// A map at its true place. The grid's z axis is along the body for HAZARDS, vertical for TRAVERSABILITY.
struct PlacedMap {
  const PassabilityMap& map;
  Eigen::Isometry3d T_map_grid;
  Eigen::Isometry3d T_grid_map;
  double ground_z_m;         // of flat ground, in the grid's frame
  Eigen::Vector2d p_camera;  // in map
};

class FidelityJudge {
 public:
  FidelityJudge(TrueRelief& relief, const RockIndex& rocks)
      : relief_(relief), rocks_(rocks), closed_m_(rocks.rocks().size(), kNaN), observed_(rocks.rocks().size(), false) {}

  void add(const PlacedMap& placed) {
    ++fidelity_.maps;
    count_looks(placed);
    count_changes(placed);
    find_closed(placed);
  }

  MapFidelity result() const {
    MapFidelity out = fidelity_;
    if (true_m2_ > 0.0) {
      out.area_ratio = impassable_m2_ / true_m2_;
      out.ideal_area_ratio = ideal_m2_ / true_m2_;
    }
    if (out.observed_cells > 0) out.changes_per_cell = static_cast<double>(changes_) / out.observed_cells;
    std::vector<double> closed_m;
    for (size_t i = 0; i < closed_m_.size(); ++i) {
      if (std::isfinite(closed_m_[i])) closed_m.push_back(closed_m_[i]);
      if (std::isnan(closed_m_[i]) && observed_[i]) ++out.rocks_never_closed;
    }
    std::sort(closed_m.begin(), closed_m.end());
    out.rocks = static_cast<int>(closed_m.size()) + out.rocks_never_closed;
    out.first_closed_median_m = quantile(closed_m, 0.5);
    out.first_closed_p10_m = quantile(closed_m, 0.1);
    return out;
  }

 private:
  struct Place {
    std::uint32_t classes = 0;  // bit of each class in which it was observed
    PassabilityMap::Cell last = PassabilityMap::kUnseen;
  };
  static_assert(kHeightClasses * kRangeClasses <= 32);

  // Centre of a cell on flat ground.
  static Eigen::Vector3d on_flat_ground(const PlacedMap& placed, int ix, int iy) {
    const PassabilityMap& map = placed.map;
    return placed.T_map_grid * Eigen::Vector3d(map.origin_x_m + (ix + 0.5) * map.cell_m,
                                               map.origin_y_m + (iy + 0.5) * map.cell_m, placed.ground_z_m);
  }
  // Moves a point along the grid's z axis to the true surface: first to the ground, then to what is on it.
  Eigen::Vector2d on_surface(const PlacedMap& placed, const Eigen::Vector3d& flat) {
    const Eigen::Vector3d up = placed.T_map_grid.linear().col(2);
    if (up.head<2>().isZero(0.0)) return flat.head<2>();
    const auto moved_to = [&](double z_m) { return (flat + up * ((z_m - flat.z()) / up.z())).head<2>().eval(); };
    return moved_to(surface_z_m(moved_to(relief_.at(flat.head<2>()).ground_m)));
  }
  double surface_z_m(const Eigen::Vector2d& p) {
    const ReliefCell& cell = relief_.at(p);
    return cell.ground_m + cell.rise_m;
  }
  PassabilityMap::Cell state_at(const PlacedMap& placed, const Eigen::Vector2d& p) {
    const Eigen::Vector3d q = placed.T_grid_map * Eigen::Vector3d(p.x(), p.y(), surface_z_m(p));
    return placed.map.at(q.x(), q.y());
  }

  void count_looks(const PlacedMap& placed) {
    const PassabilityMap& map = placed.map;
    for (int iy = 0; iy < map.cells_y; ++iy)
      for (int ix = 0; ix < map.cells_x; ++ix) {
        const PassabilityMap::Cell state = map.cells[static_cast<size_t>(iy * map.cells_x + ix)];
        if (state == PassabilityMap::kUnseen) continue;
        const Eigen::Vector3d flat = on_flat_ground(placed, ix, iy);
        if ((flat.head<2>() - placed.p_camera).norm() > kMaxRangeM + kMaxShiftM) continue;
        const Eigen::Vector2d p = on_surface(placed, flat);
        const double range_m = (p - placed.p_camera).norm();
        if (range_m < kMaxRangeM) count_look(placed, p, range_m, state == PassabilityMap::kImpassable);
      }
  }
  // The true height of a cell: the highest of its four quarters.
  void count_look(const PlacedMap& placed, const Eigen::Vector2d& p, double range_m, bool impassable) {
    double rise_m = -kInfinity;
    double tall_ratio = 0.0;
    const Eigen::Matrix2d axes = placed.T_map_grid.linear().topLeftCorner<2, 2>() * (0.25 * placed.map.cell_m);
    for (const double u : {-1.0, 1.0})
      for (const double v : {-1.0, 1.0}) {
        const ReliefCell& quarter = relief_.at(p + axes * Eigen::Vector2d(u, v));
        rise_m = std::max<double>(rise_m, quarter.rise_m);
        tall_ratio += 0.25 * quarter.tall_ratio;
      }
    const size_t height = class_of(rise_m, kFidelityHeightsM);
    const size_t range = class_of(range_m, kFidelityRangesM);
    FidelityCount& count = fidelity_.counts[height][range];
    ++count.looks;
    count.impassable += impassable ? 1 : 0;
    std::uint32_t& classes = places_.at_point(p.x(), p.y()).classes;
    const std::uint32_t bit = 1U << (height * kRangeClasses + range);
    count.cells += (classes & bit) == 0 ? 1 : 0;
    classes |= bit;
    if (range_m >= kAreaRangeM) return;
    const double cell_m2 = placed.map.cell_m * placed.map.cell_m;
    impassable_m2_ += impassable ? cell_m2 : 0.0;
    ideal_m2_ += rise_m >= kHazardRockM ? cell_m2 : 0.0;
    true_m2_ += tall_ratio * cell_m2;
  }

  // Places read the map, so that a cell that turns with the rover is not counted twice or left out.
  void count_changes(const PlacedMap& placed) {
    const Eigen::AlignedBox2d box = box_of(placed);
    if (box.isEmpty()) return;
    for (int iy = places_.index_of(box.min().y()); iy <= places_.index_of(box.max().y()); ++iy)
      for (int ix = places_.index_of(box.min().x()); ix <= places_.index_of(box.max().x()); ++ix) {
        const Eigen::Vector2d p(places_.center_m(ix), places_.center_m(iy));
        if ((p - placed.p_camera).norm() >= kMaxRangeM) continue;
        const PassabilityMap::Cell state = state_at(placed, p);
        if (state == PassabilityMap::kUnseen) continue;
        Place& place = places_.at(ix, iy);
        if (place.last == PassabilityMap::kUnseen)
          ++fidelity_.observed_cells;
        else if (place.last != state)
          ++changes_;
        place.last = state;
      }
  }

  // Around the map, within the range of the camera.
  static Eigen::AlignedBox2d box_of(const PlacedMap& placed) {
    const Eigen::Vector2d relief = Eigen::Vector2d::Constant(kMaxShiftM);
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kMaxRangeM);
    const PassabilityMap& map = placed.map;
    Eigen::AlignedBox2d corners;
    for (const double u : {0.0, map.cells_x * map.cell_m})
      for (const double v : {0.0, map.cells_y * map.cell_m}) {
        const Eigen::Vector3d corner(map.origin_x_m + u, map.origin_y_m + v, placed.ground_z_m);
        corners.extend((placed.T_map_grid * corner).head<2>());
      }
    const Eigen::AlignedBox2d around(corners.min() - relief, corners.max() + relief);
    return around.intersection(Eigen::AlignedBox2d(placed.p_camera - reach, placed.p_camera + reach));
  }

  void find_closed(const PlacedMap& placed) {
    for (const size_t i : rocks_.near(placed.p_camera, kMaxRangeM)) {
      if (std::isfinite(closed_m_[i])) continue;
      const Rock& rock = rocks_.rocks()[i];
      const Eigen::Vector2d center(rock.x_m, rock.y_m);
      const double distance_m = (center - placed.p_camera).norm();
      if (distance_m < kSeenRangeM && state_at(placed, center) != PassabilityMap::kUnseen) observed_[i] = true;
      if (closes(placed, rock)) closed_m_[i] = std::max(0.0, distance_m - rock.radius_m);
    }
  }
  bool closes(const PlacedMap& placed, const Rock& rock) {
    const int reach = static_cast<int>(rock.radius_m / kRockStepM);
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const Eigen::Vector2d offset(i * kRockStepM, j * kRockStepM);
        if (offset.norm() > rock.radius_m) continue;
        if (state_at(placed, offset + Eigen::Vector2d(rock.x_m, rock.y_m)) == PassabilityMap::kImpassable) return true;
      }
    return false;
  }

  TrueRelief& relief_;
  const RockIndex& rocks_;
  oracle::TiledGrid<Place> places_{kPlaceM};
  MapFidelity fidelity_;
  double impassable_m2_ = 0.0;
  double ideal_m2_ = 0.0;
  double true_m2_ = 0.0;
  std::int64_t changes_ = 0;
  std::vector<double> closed_m_;  // of each rock; NaN: never
  std::vector<bool> observed_;
};

bool valid(const Eigen::Isometry3d& T) {
  return is_finite(T) && T.translation().cwiseAbs().maxCoeff() < kMaxPlaceM && std::abs(T.linear()(2, 2)) > 0.1;
}

Eigen::Vector2d camera_at(const Eigen::Isometry3d& T_map_body, double camera_x_m) {
  return (T_map_body * Eigen::Vector3d(camera_x_m, 0.0, 0.0)).head<2>();
}

}  // namespace

MapFidelities map_fidelities(const RunRecord& run, const TrueTrack& truth, const Window& window,
                             const Footprint& footprint, const TrueWorld& world) {
  MapFidelities out;
  if (truth.empty() || !world.height_m || !world.ground_m) return out;
  TrueRelief relief(world);
  const RockIndex rocks(hazards_of(world.rocks));
  FidelityJudge hazards(relief, rocks);
  FidelityJudge traversability(relief, rocks);
  for (const PassabilityMap& map : run.hazard_maps) {
    const Eigen::Isometry3d T = truth.at(map.t_s);
    if (window.contains(map.t_s) && valid(T))
      hazards.add({map, T, T.inverse(), -footprint.origin_height_m, camera_at(T, footprint.loccam_x_m)});
  }
  for (const PassabilityMap& map : run.traversability_maps) {
    const Eigen::Isometry3d T = truth.at(map.t_s);
    const PoseSample* pose = newest(run.poses, map.t_s);
    if (!window.contains(map.t_s) || !valid(T) || pose == nullptr) continue;
    const Eigen::Isometry3d T_map_odom = from_planar(compose(planar(T), inverse(planar(pose->T_odom_body))));
    if (!valid(T_map_odom)) continue;
    traversability.add({map, T_map_odom, T_map_odom.inverse(), 0.0, camera_at(T, footprint.navcam_x_m)});
  }
  if (hazards.result().maps > 0) out.hazards = hazards.result();
  if (traversability.result().maps > 0) out.traversability = traversability.result();
  return out;
}

}  // namespace rover::report
