#include "common/geo/geography.hpp"

#include "common/core/frames.hpp"
#include "common/geo/gdal_session.hpp"
#include "common/geo/projections.hpp"

namespace rover {

struct Geography::Transforms {
  CoordinateChange to_lon_lat, to_projection;
};

Geography::Geography(const ElevationRaster& raster)
    : transforms_(std::make_unique<Transforms>()), corner_m_(raster.west_m, raster.south_m) {
  const GdalSession gdal;
  const OGRSpatialReference projection = reference_from(raster.projection_wkt);
  const auto geographic = geographic_of(projection);
  if (!geographic) return;
  transforms_->to_lon_lat = change(projection, *geographic);
  transforms_->to_projection = change(*geographic, projection);
}

Geography::~Geography() = default;

bool Geography::is_known() const {
  return transforms_->to_lon_lat && transforms_->to_projection;
}

Eigen::Vector2d Geography::to_map(const Eigen::Vector2d& lon_lat_deg) const {
  if (!is_known()) return {kNaN, kNaN};
  const GdalSession gdal;
  return changed(*transforms_->to_projection, lon_lat_deg) - corner_m_;
}

Eigen::Vector2d Geography::to_lon_lat(const Eigen::Vector2d& map_m) const {
  if (!is_known()) return {kNaN, kNaN};
  const GdalSession gdal;
  return changed(*transforms_->to_lon_lat, map_m + corner_m_);
}

}  // namespace rover
