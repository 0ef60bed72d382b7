#include "common/geo/projections.hpp"

#include <cpl_conv.h>

#include "common/core/frames.hpp"

namespace rover {

std::string wkt_of(const OGRSpatialReference& reference) {
  char* text = nullptr;
  reference.exportToWkt(&text);
  const std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  return wkt;
}

OGRSpatialReference reference_from(const std::string& wkt) {
  OGRSpatialReference reference;
  reference.importFromWkt(wkt.c_str());
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

std::unique_ptr<OGRSpatialReference> geographic_of(const OGRSpatialReference& reference) {
  std::unique_ptr<OGRSpatialReference> geographic(reference.CloneGeogCS());
  if (geographic) geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return geographic;
}

CoordinateChange change(const OGRSpatialReference& from, const OGRSpatialReference& to) {
  return CoordinateChange(OGRCreateCoordinateTransformation(&from, &to));
}

Eigen::Vector2d changed(OGRCoordinateTransformation& change, Eigen::Vector2d p) {
  int ok = 0;
  if (!change.Transform(1, &p.x(), &p.y(), nullptr, &ok) || !ok || !p.allFinite()) return {kNaN, kNaN};
  return p;
}

OGRSpatialReference plane_about(const OGRSpatialReference& reference, const Eigen::Vector2d& lon_lat_deg) {
  OGRSpatialReference plane;
  plane.SetProjCS("local stereographic");
  plane.CopyGeogCSFrom(&reference);
  plane.SetStereographic(lon_lat_deg.y(), lon_lat_deg.x(), 1.0, 0.0, 0.0);
  plane.SetLinearUnits(SRS_UL_METER, 1.0);
  plane.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return plane;
}

}  // namespace rover
