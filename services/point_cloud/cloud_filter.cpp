#include "point_cloud/cloud_filter.hpp"

#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>

namespace rover::cloud {
namespace {

// The intensity carries the sigma, so that the filters keep it with the point.
using PclCloud = pcl::PointCloud<pcl::PointXYZI>;

PclCloud::Ptr to_pcl(const Cloud& cloud) {
  auto out = std::make_shared<PclCloud>();
  out->reserve(cloud.size());
  for (const Point& p : cloud) out->push_back({p.x_m, p.y_m, p.z_m, p.depth_sigma_m});
  return out;
}

Cloud from_pcl(const PclCloud& cloud) {
  Cloud out;
  out.reserve(cloud.size());
  for (const pcl::PointXYZI& p : cloud) out.push_back({p.x, p.y, p.z, p.intensity});
  return out;
}

PclCloud::Ptr one_a_voxel(const PclCloud::Ptr& cloud, double voxel_m) {
  pcl::VoxelGrid<pcl::PointXYZI> grid;
  const auto leaf = static_cast<float>(voxel_m);
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(cloud);
  auto out = std::make_shared<PclCloud>();
  grid.filter(*out);
  return out;
}

PclCloud without_outliers(const PclCloud::Ptr& cloud, const FilterConfig& config) {
  pcl::RadiusOutlierRemoval<pcl::PointXYZI> removal;
  removal.setRadiusSearch(config.outlier_radius_m);
  removal.setMinNeighborsInRadius(config.outlier_neighbours);
  removal.setInputCloud(cloud);
  PclCloud out;
  removal.filter(out);
  return out;
}

// Nearest first, where there are too many.
void leave_out_farthest(Cloud& cloud, size_t max_points) {
  if (cloud.size() <= max_points) return;
  std::stable_sort(cloud.begin(), cloud.end(), [](const Point& a, const Point& b) { return a.z_m < b.z_m; });
  cloud.resize(max_points);
}

}  // namespace

Cloud filtered(const Cloud& cloud, const FilterConfig& config) {
  if (cloud.empty()) return {};  // PCL's search trees do not take an empty cloud
  Cloud out = from_pcl(without_outliers(one_a_voxel(to_pcl(cloud), config.voxel_m), config));
  leave_out_farthest(out, static_cast<size_t>(config.max_points));
  return out;
}

}  // namespace rover::cloud
