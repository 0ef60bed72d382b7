#include "tools/report/scene.hpp"

namespace rover::report {

Points thinned(const Points& line, double step_m) {
  Points thin;
  for (const Eigen::Vector2d& p : line)
    if (thin.empty() || (p - thin.back()).norm() >= step_m) thin.push_back(p);
  if (!line.empty() && thin.back() != line.back()) thin.push_back(line.back());
  return thin;
}

Points true_line(const Scene& scene) {
  Points line;
  for (const TruthSample& sample : scene.run.truth) line.emplace_back(sample.T_map_body.translation().head<2>());
  return thinned(line, 0.05);
}

Points estimated_line(const Scene& scene) {
  Points line;
  for (const PoseSample& pose : scene.run.poses)
    line.emplace_back((pose.T_map_odom * pose.T_odom_body).translation().head<2>());
  return thinned(line, 0.05);
}

Points odometry_line(const Scene& scene) {
  const TrueTrack truth(scene.run.truth);
  const Pose2 align = start_alignment(scene.run, truth, scene.evaluation.metrics.window);
  Points line;
  for (const PoseSample& pose : scene.run.poses)
    line.push_back(transform(align, pose.T_odom_body.translation().head<2>()));
  return thinned(line, 0.05);
}

Points planned_line(const Scene& scene) {
  const std::vector<PathRecord>& paths = scene.evaluation.metrics.paths;
  return paths.empty() ? Points{} : paths.back().points;
}

}  // namespace rover::report
