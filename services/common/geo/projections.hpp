// Coordinate systems of maps, through GDAL.
#pragma once

#include <ogr_spatialref.h>

#include <Eigen/Core>
#include <memory>
#include <string>

namespace rover {

using CoordinateChange = std::unique_ptr<OGRCoordinateTransformation>;

std::string wkt_of(const OGRSpatialReference& reference);
// Longitude first and easting first, whatever order the authority prescribes.
OGRSpatialReference reference_from(const std::string& wkt);
// Longitude and latitude on the reference's own body; null where it has none.
std::unique_ptr<OGRSpatialReference> geographic_of(const OGRSpatialReference& reference);
// Null where GDAL knows none.
CoordinateChange change(const OGRSpatialReference& from, const OGRSpatialReference& to);
// NaN where the place has no counterpart.
Eigen::Vector2d changed(OGRCoordinateTransformation& change, Eigen::Vector2d p);
// A plane in metres that is true about a place, on the reference's own body.
OGRSpatialReference plane_about(const OGRSpatialReference& reference, const Eigen::Vector2d& lon_lat_deg);

}  // namespace rover
