#include "test/slam/teide_study.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "slam/slam.hpp"

namespace rover::slam::study {
namespace {

constexpr int kStarts = 20;
constexpr int kTriesPerStart = 4;                                     // per start
constexpr double kStartOffsetM = 1.0, kStartOffsetRad = to_rad(5.0);  // maximum offset of the starts
constexpr double kMaxSpreadM = 0.5;
constexpr double kMinReliefM = 0.10;    // rms about the plane; fixed before the experiment
constexpr double kMinOverlap = 0.3;     // share of a cloud's patches seen by its neighbour
constexpr int kNeighbourWindow = 5;     // maximum index difference
constexpr int kMaxNeighboursTried = 4;  // those with the largest overlap
constexpr double kMaxRangeM = 40.0;
constexpr double kDepthSigmaPerM2 = 0.1 / (818.0 * 0.24);  // sigma / range^2 [1/m] of the filtered cloud

// Binary PCD with x, y, z as float. Skips points that are not finite or behind the rover.
Cloud read_pcd(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  size_t points = 0;
  while (std::getline(in, line) && line != "DATA binary")
    if (line.starts_with("POINTS ")) points = std::stoul(line.substr(7));
  std::vector<float> values(3 * points);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  Cloud cloud;
  cloud.T_body_cam = make_pose(camera_rotation(0.0), Eigen::Vector3d::Zero());
  for (size_t i = 0; i < points; ++i) {
    const float x = values[3 * i], y = values[3 * i + 1], z = values[3 * i + 2];
    const float range = std::hypot(x, y);
    if (!(x > 0.5F) || !(range < 60.0F) || !std::isfinite(z)) continue;
    cloud.points.push_back({{-y, -z, x}, static_cast<float>(kDepthSigmaPerM2) * range * range});
  }
  return cloud;
}

SlamConfig coarse_config() {
  SlamConfig config;
  config.map.cells = 270;
  config.map.patches.cell_m = 0.3;
  config.map.patches.max_range_m = kMaxRangeM;
  config.match.max_range_m = kMaxRangeM;
  config.match.height_sigma_m = 0.3;
  config.match.tilt_sigma_rad = to_rad(1.0);
  config.match.max_patches = 1500;
  config.match.min_patches = 100;
  config.match.temper = 3.0;
  config.match.horizontal_sigma_m = 0.04;
  config.match.model_sigma_m = 0.015;
  config.filter.min_particles = config.filter.max_particles = 500;
  return config;
}

// Rms of the heights about their least-squares plane.
double relief_m(const std::vector<Patch>& patches) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Patch& p : patches) {
    const Eigen::Vector3d row(1.0, p.x_m, p.y_m);
    A += row * row.transpose();
    b += static_cast<double>(p.z_m) * row;
  }
  const Eigen::Vector3d plane = A.ldlt().solve(b);
  double squares = 0.0;
  for (const Patch& p : patches) squares += std::pow(p.z_m - plane.dot(Eigen::Vector3d(1.0, p.x_m, p.y_m)), 2);
  return std::sqrt(squares / static_cast<double>(std::max<size_t>(1, patches.size())));
}

// Map of a single cloud, with the rover at the origin.
struct LocalMap {
  AlignedCloud cloud;
  std::vector<Patch> patches;
  ElevationMap map;
  explicit LocalMap(const Cloud& raw, const SlamConfig& config)
      : cloud(align_to_gravity(raw, Eigen::Isometry3d::Identity(), config.attitude)),
        patches(PatchBinner(config.map.patches).bin_cloud(cloud, {})),
        map(config.map) {
    map.move_to(0, 0);
    map.insert(cloud, {});
  }
};

double overlap(const LocalMap& cloud, const LocalMap& with) {
  const MatchSurface surface(with.map, 0.0, 0.0);
  int seen = 0;
  for (const Patch& p : cloud.patches)
    seen += surface.sample(static_cast<float>((p.x_m - surface.corner_x_m()) / surface.cell_m()),
                           static_cast<float>((p.y_m - surface.corner_y_m()) / surface.cell_m()))
                    .has_value()
                ? 1
                : 0;
  return static_cast<double>(seen) / static_cast<double>(std::max<size_t>(1, cloud.patches.size()));
}

struct Registration {
  Pose2 pose;
  double score = -kInfinity;  // log-likelihood per patch
  double inlier_ratio = 0.0;
};

// Annealed particle filter: the noise shrinks each round.
std::optional<Registration> annealed_registration(const std::vector<Patch>& patches, const MatchSurface& surface,
                                                  const SlamConfig& config, const Pose2& start, Random& random) {
  ScanMatcher matcher(config.match);
  ParticleFilter filter(config.filter);
  filter.reset(start);
  for (const double sigma : {1.2, 0.6, 0.3, 0.15, 0.08, 0.04}) {
    matcher.prepare(patches, surface, filter.mean());
    if (!matcher.has_enough_points()) return std::nullopt;
    filter.predict({}, {sigma, sigma, sigma * to_rad(4.0)}, random);
    filter.update([&](const Pose2& pose) { return matcher.fit(pose).log_likelihood; });
    filter.resample(random);
  }
  matcher.prepare(patches, surface, filter.mean());
  if (!matcher.has_enough_points()) return std::nullopt;
  const MatchFit fit = matcher.fit(filter.mean(), 4);
  return Registration{filter.mean(), fit.log_likelihood / matcher.matched_points(), fit.inlier_ratio};
}

// Best of several runs from one start, as a single run may end in a local optimum.
std::optional<Registration> best_registration(const std::vector<Patch>& patches, const MatchSurface& surface,
                                              const SlamConfig& config, const Pose2& start, Random& random) {
  std::optional<Registration> best;
  for (int i = 0; i < kTriesPerStart; ++i)
    if (const auto end = annealed_registration(patches, surface, config, start, random);
        end && (!best || end->score > best->score))
      best = end;
  return best;
}

struct Convergence {
  double relief_m = 0.0, overlap = 0.0, spread_m = kInfinity, inlier_ratio = 0.0;
  int neighbour = -1;
  bool converged() const { return spread_m <= kMaxSpreadM; }
};

// Registers to one neighbour from all starts.
Convergence register_from_random_starts(const LocalMap& cloud, const LocalMap& with, const SlamConfig& config,
                                        std::uint64_t seed) {
  Convergence convergence;
  const MatchSurface surface(with.map, 0.0, 0.0);
  std::vector<Pose2> ends;
  Random random(seed);
  for (int k = 0; k < kStarts; ++k) {
    const Pose2 start{kStartOffsetM * (2 * random.unit() - 1), kStartOffsetM * (2 * random.unit() - 1),
                      kStartOffsetRad * (2 * random.unit() - 1)};
    const auto end = best_registration(cloud.patches, surface, config, start, random);
    if (!end) return convergence;
    ends.push_back(end->pose);
    convergence.inlier_ratio += end->inlier_ratio / kStarts;
  }
  convergence.spread_m = 0.0;
  for (const Pose2& a : ends)
    for (const Pose2& b : ends)
      convergence.spread_m = std::max(convergence.spread_m, std::hypot(a.x_m - b.x_m, a.y_m - b.y_m));
  return convergence;
}

// The first neighbour, by overlap, with which registration converges, else the best one.
Convergence best_neighbour(const std::vector<LocalMap>& clouds, int i, const SlamConfig& config) {
  const LocalMap& cloud = clouds[static_cast<size_t>(i)];
  std::vector<std::pair<double, int>> neighbours;
  for (int j = std::max(0, i - kNeighbourWindow);
       j <= std::min(static_cast<int>(clouds.size()) - 1, i + kNeighbourWindow); ++j)
    if (j != i) neighbours.emplace_back(overlap(cloud, clouds[static_cast<size_t>(j)]), j);
  std::sort(neighbours.rbegin(), neighbours.rend());
  Convergence best;
  for (size_t k = 0; k < std::min<size_t>(kMaxNeighboursTried, neighbours.size()); ++k) {
    const auto [share, j] = neighbours[k];
    if (k > 0 && share < kMinOverlap) break;
    Convergence convergence = register_from_random_starts(cloud, clouds[static_cast<size_t>(j)], config,
                                                          static_cast<std::uint64_t>(1000 + i));
    convergence.overlap = share;
    convergence.neighbour = j;
    if (k == 0 || convergence.spread_m < best.spread_m) best = convergence;
    if (best.converged()) break;
  }
  best.relief_m = relief_m(cloud.patches);
  return best;
}

std::string failure_reason(const Convergence& v) {
  if (v.relief_m < kMinReliefM) return "no relief";
  if (v.overlap < kMinOverlap) return "no neighbour has seen the same ground";
  if (v.spread_m == kInfinity) return "too few common patches";
  return v.converged() ? "" : "several places fit equally well";
}

}  // namespace

bool teide_study(const std::string& folder) {
  if (!std::filesystem::exists(folder)) {
    fmt::print("Left out: {} is not there.\n", folder);
    return true;
  }
  const SlamConfig config = coarse_config();
  Slam slam({});
  std::vector<LocalMap> clouds;
  int mapped = 0;
  for (int i = 0; std::filesystem::exists(fmt::format("{}/local_cloud_{}.pcd", folder, i)); ++i) {
    Cloud cloud = read_pcd(fmt::format("{}/local_cloud_{}.pcd", folder, i));
    cloud.utime = to_utime(10.0 * (i + 1));
    mapped += slam.step(cloud, {Eigen::Isometry3d::Identity(), 0.0, 0.0}).rejection.empty() ? 1 : 0;
    clouds.emplace_back(cloud, config);
  }
  fmt::print("{} of {} local clouds went through mapping.\n\n", mapped, clouds.size());
  fmt::print(
      "| cloud | points | relief | neighbour | common ground | ends apart | fitting | converges "
      "|\n|---|---|---|---|---|---|---|---|\n");
  int with_relief = 0, converged = 0;
  for (int i = 0; i < static_cast<int>(clouds.size()); ++i) {
    const Convergence v = best_neighbour(clouds, i, config);
    const bool relief = v.relief_m >= kMinReliefM;
    with_relief += relief ? 1 : 0;
    converged += relief && v.converged() ? 1 : 0;
    fmt::print("| {} | {} | {:.2f} m | {} | {:.0f} % | {:.2f} m | {:.0f} % | {}{} |\n", i,
               clouds[static_cast<size_t>(i)].cloud.points.size(), v.relief_m, v.neighbour, 100 * v.overlap, v.spread_m,
               100 * v.inlier_ratio, v.converged() ? "yes" : "no",
               failure_reason(v).empty() ? "" : ": " + failure_reason(v));
  }
  fmt::print("\n{} of {} clouds with relief converge ({:.0f} %).\n", converged, with_relief,
             100.0 * converged / std::max(1, with_relief));
  return mapped == static_cast<int>(clouds.size()) && converged >= 0.8 * with_relief;
}

}  // namespace rover::slam::study
