// Coordinate systems of maps, through GDAL.
#pragma once

#include <ogr_spatialref.h>

#include <Eigen/Core>
#include <memory>
#include <string>

namespace rover {

using CoordinateChange = std::unique_ptr<OGRCoordinateTransformation>;

std::string wkt_of(const OGRSpatialReference& reference);
// With longitude and easting first, whatever the authority's axis order.
OGRSpatialReference reference_from(const std::string& wkt);
// Longitude and latitude on the reference's own body; null if it has none.
std::unique_ptr<OGRSpatialReference> geographic_of(const OGRSpatialReference& reference);
// Null if GDAL knows none.
CoordinateChange change(const OGRSpatialReference& from, const OGRSpatialReference& to);
// NaN if there is no result.
Eigen::Vector2d changed(OGRCoordinateTransformation& change, Eigen::Vector2d p);
// Stereographic plane in metres about a place, on the reference's own body.
OGRSpatialReference plane_about(const OGRSpatialReference& reference, const Eigen::Vector2d& lon_lat_deg);

}  // namespace rover
