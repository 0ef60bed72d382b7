#include "common/geo/placement.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/frames.hpp"
#include "common/geo/elevation_map.hpp"

namespace rover {
namespace {

using Eigen::Vector2d;

constexpr double kScaleError = 0.01;  // relative scale error of the projection
constexpr double kNearlyAll = 0.9;
constexpr int kPointsPerSide = 33;
constexpr double kMaxCells = 1e9;  // along a side; more than any accepted map
// At this distance a stereographic projection has a scale error of 1 % (1 + d^2 / 4 R^2).
constexpr double kFarthestRadii = 0.2;

struct Rectangle {
  Vector2d low = Vector2d::Constant(kInfinity), high = Vector2d::Constant(-kInfinity);
  void add(const Vector2d& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  double area() const { return (high - low).cwiseMax(0.0).prod(); }
};

using Side = std::vector<Vector2d>;

Rectangle around(const std::vector<Side>& sides) {
  Rectangle rectangle;
  for (const Side& side : sides)
    for (const Vector2d& p : side) rectangle.add(p);
  return rectangle;
}

// Each side of the map bounds the axis along which its midpoint is farther out.
Rectangle inside(const std::vector<Side>& sides, const Rectangle& outer) {
  Rectangle inner = outer;
  const Vector2d middle = 0.5 * (outer.low + outer.high), half = 0.5 * (outer.high - outer.low);
  for (const Side& side : sides) {
    const Vector2d out = (side[kPointsPerSide / 2] - middle).cwiseQuotient(half);
    const int axis = std::abs(out.x()) > std::abs(out.y()) ? 0 : 1;
    for (const Vector2d& p : side)
      if (out[axis] > 0.0)
        inner.high[axis] = std::min(inner.high[axis], p[axis]);
      else
        inner.low[axis] = std::max(inner.low[axis], p[axis]);
  }
  return inner;
}

}  // namespace

Placement::Placement(GDALDataset& dataset, const std::string& file)
    : file_(file), width_(dataset.GetRasterXSize()), height_(dataset.GetRasterYSize()) {
  const OGRSpatialReference* reference = dataset.GetSpatialRef();
  const auto finite = [](double value) { return std::isfinite(value); };
  const bool placed = dataset.GetGeoTransform(transform_.data()) == CE_None &&
                      std::all_of(transform_.begin(), transform_.end(), finite);
  if (!placed && dataset.GetGCPCount() > 0)
    throw DtmError(file + ": has ground control points instead of a georeference; georeference it with gdalwarp first");
  if (!placed || reference == nullptr)
    throw DtmError(file + ": has no georeference" + (placed ? " (no coordinate system)" : "") +
                   "; give it one (gdal_edit.py -a_srs, -a_ullr), as LOCAL_CS[\"site\",UNIT[\"metre\",1]] if it has "
                   "none on a planet");
  reference_ = *reference;
  reference_.StripVertical();
  const bool flat = reference_.IsLocal() || reference_.IsProjected() || reference_.IsGeographic();
  if (!flat)
    throw DtmError(file + ": its coordinate system is not a map projection; reproject it with gdalwarp -t_srs");
  if (is_local() && !is_metric()) throw DtmError(file + ": is not north-up with square pixels; gdalwarp makes it so");
  if (is_local()) return;
  if (const auto geographic = geographic_of(reference_)) to_lon_lat_ = change(reference_, *geographic);
  if (const double area = std::abs(middle_pixel().determinant()); !(area > 0.0 && std::isfinite(area)))
    throw DtmError(file +
                   ": its projection does not lead to longitude and latitude; reproject it with gdalwarp -t_srs");
}

Vector2d Placement::at(double column, double line) const {
  return {transform_[0] + transform_[1] * column + transform_[2] * line,
          transform_[3] + transform_[4] * column + transform_[5] * line};
}

Vector2d Placement::lon_lat_at(double column, double line) const {
  return to_lon_lat_ ? changed(*to_lon_lat_, at(column, line)) : Vector2d(kNaN, kNaN);
}

Eigen::Matrix2d Placement::pixel_at(double column, double line) const {
  const Eigen::Matrix2d unknown = Eigen::Matrix2d::Constant(kNaN);
  const Vector2d place = lon_lat_at(column, line);
  if (!place.allFinite()) return unknown;
  const CoordinateChange to_plane = change(reference_, plane_about(reference_, place));
  if (!to_plane) return unknown;
  const auto ground = [&](double c, double l) { return changed(*to_plane, at(c, l)); };
  Eigen::Matrix2d pixel;
  pixel << ground(column + 0.5, line) - ground(column - 0.5, line),
      ground(column, line - 0.5) - ground(column, line + 0.5);
  return pixel;
}

bool Placement::is_true_at(double column, double line) const {
  const Eigen::Matrix2d scale = pixel_at(column, line) / transform_[1];
  const Eigen::Matrix2d error = scale.transpose() * scale - Eigen::Matrix2d::Identity();
  // Not mirrored.
  return (error.cwiseAbs().array() < 2.0 * kScaleError).all() && scale.determinant() > 0.0;
}

bool Placement::is_metric() const {
  const auto& t = transform_;
  if (is_local() && !(reference_.GetLinearUnits() > 0.0)) return false;
  if (t[2] != 0.0 || t[4] != 0.0 || t[1] <= 0.0 || std::abs(t[1] + t[5]) > 1e-6 * t[1]) return false;
  if (is_local()) return true;
  const double last_column = width_ - 0.5, last_line = height_ - 0.5;
  return is_true_at(0.5 * width_, 0.5 * height_) && is_true_at(0.5, 0.5) && is_true_at(last_column, 0.5) &&
         is_true_at(0.5, last_line) && is_true_at(last_column, last_line);
}

double Placement::pixel_m() const {
  if (is_local()) return transform_[1] * reference_.GetLinearUnits();
  return middle_pixel().colwise().norm().maxCoeff();
}

std::string Placement::size() const {
  std::string text = fmt::format("{} x {} pixels", width_, height_);
  if (is_local()) return text;
  const Eigen::RowVector2d pixel_m = middle_pixel().colwise().norm();
  return text + fmt::format(", {:.3g} x {:.3g} km", 1e-3 * width_ * pixel_m.x(), 1e-3 * height_ * pixel_m.y());
}

TargetGrid Placement::own_grid() const {
  TargetGrid grid{wkt_of(reference_)};
  double unit_m = 1.0;
  if (is_local() && (unit_m = reference_.GetLinearUnits()) != 1.0) {
    OGRSpatialReference metres;
    metres.SetLocalCS(reference_.GetName());
    metres.SetLinearUnits(SRS_UL_METER, 1.0);
    grid.wkt = wkt_of(metres);
  }
  grid.resolution_m = transform_[1] * unit_m;
  grid.width = width_;
  grid.height = height_;
  grid.west_m = transform_[0] * unit_m;
  grid.south_m = (transform_[3] + transform_[5] * height_) * unit_m;
  return grid;
}

std::vector<std::vector<Vector2d>> Placement::sides_in(OGRCoordinateTransformation& to_plane) const {
  std::vector<Side> sides(4);
  for (int i = 0; i < kPointsPerSide; ++i) {
    const double u = static_cast<double>(i) / (kPointsPerSide - 1), x = u * width_, y = u * height_;
    const Vector2d on_side[4] = {{x, 0.0}, {x, height_}, {0.0, y}, {width_, y}};
    for (int s = 0; s < 4; ++s) sides[s].push_back(changed(to_plane, at(on_side[s].x(), on_side[s].y())));
  }
  const double farthest_m = kFarthestRadii * reference_.GetSemiMajor();
  for (const Side& side : sides)
    for (const Vector2d& p : side)
      if (!(p.norm() < farthest_m))
        throw DtmError(
            fmt::format("{}: too wide to be reprojected to metres ({}; at most {:.0f} km from its middle to a corner); "
                        "cut out a part (gdal_translate -projwin)",
                        file_, size(), 1e-3 * farthest_m));
  return sides;
}

TargetGrid Placement::plane_grid() const {
  const Vector2d middle(0.5 * width_, 0.5 * height_);
  const OGRSpatialReference plane = plane_about(reference_, lon_lat_at(middle.x(), middle.y()));
  const CoordinateChange to_plane = change(reference_, plane);
  if (!to_plane) throw DtmError(file_ + ": cannot be reprojected to metres; reproject it with gdalwarp -t_srs");
  const std::vector<Side> sides = sides_in(*to_plane);
  const Rectangle outer = around(sides), inner = inside(sides, outer);
  const bool is_inside = inner.area() > kNearlyAll * outer.area();
  const Rectangle& chosen = is_inside ? inner : outer;
  const double resolution_m = std::sqrt(std::abs(middle_pixel().determinant()));
  const auto whole = [&](double m) {
    const double cells = m / resolution_m;
    return std::clamp(is_inside ? std::floor(cells) : std::ceil(cells), 1.0, kMaxCells);
  };
  const Vector2d cells((chosen.high - chosen.low).unaryExpr(whole));
  const Vector2d corner = 0.5 * (chosen.low + chosen.high - resolution_m * cells);
  return {wkt_of(plane), corner.x(), corner.y(), resolution_m, std::llround(cells.x()), std::llround(cells.y())};
}

}  // namespace rover
