#include "point_cloud/cloud_filter.hpp"

#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>

namespace rover::cloud {
namespace {

// The intensity field carries sigma through the filters, and the curvature the brightness.
using PclPoint = pcl::PointXYZINormal;
using PclCloud = pcl::PointCloud<PclPoint>;

PclCloud::Ptr to_pcl(const Cloud& cloud) {
  auto out = std::make_shared<PclCloud>();
  out->reserve(cloud.size());
  for (const Point& p : cloud) {
    PclPoint point(p.x_m, p.y_m, p.z_m, p.depth_sigma_m);
    point.curvature = p.brightness;
    out->push_back(point);
  }
  return out;
}

Cloud from_pcl(const PclCloud& cloud) {
  Cloud out;
  out.reserve(cloud.size());
  for (const PclPoint& p : cloud) out.push_back({p.x, p.y, p.z, p.intensity, p.curvature});
  return out;
}

PclCloud::Ptr downsample_voxels(const PclCloud::Ptr& cloud, double voxel_m) {
  pcl::VoxelGrid<PclPoint> grid;
  const auto leaf = static_cast<float>(voxel_m);
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(cloud);
  auto out = std::make_shared<PclCloud>();
  grid.filter(*out);
  return out;
}

PclCloud remove_outliers(const PclCloud::Ptr& cloud, const FilterConfig& config) {
  pcl::RadiusOutlierRemoval<PclPoint> removal;
  removal.setRadiusSearch(config.outlier_radius_m);
  removal.setMinNeighborsInRadius(config.outlier_neighbours);
  removal.setInputCloud(cloud);
  PclCloud out;
  removal.filter(out);
  return out;
}

// Sorts by depth only if points must be dropped.
void keep_nearest(Cloud& cloud, size_t max_points) {
  if (cloud.size() <= max_points) return;
  std::stable_sort(cloud.begin(), cloud.end(), [](const Point& a, const Point& b) { return a.z_m < b.z_m; });
  cloud.resize(max_points);
}

}  // namespace

Cloud filter_cloud(const Cloud& cloud, const FilterConfig& config) {
  if (cloud.empty()) return {};  // PCL's search trees reject an empty cloud
  Cloud out = from_pcl(remove_outliers(downsample_voxels(to_pcl(cloud), config.voxel_m), config));
  keep_nearest(out, static_cast<size_t>(config.max_points));
  return out;
}

}  // namespace rover::cloud
