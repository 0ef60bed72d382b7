#include "global_localization/global_localization.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "global_localization/terrain_template.hpp"

namespace rover::global {
namespace {

constexpr int kCoarsePeaks = 64;       // of a coarse search, to refine
constexpr int kChanceSide = 15;        // places along a side of the window that tell what chance gives
constexpr double kMinSinceFixM = 1.0;  // keeps the covariance finite right after a fix

Eigen::Vector2d transformed(const Pose2& T, const Eigen::Vector2d& p) {
  return Eigen::Vector2d(T.x_m, T.y_m) + Eigen::Rotation2Dd(T.yaw_rad) * p;
}

// T_map_odom that moves the template's centre to the candidate pose.
Pose2 transform_of(const CandidatePose& pose, const Eigen::Vector2d& center_odom) {
  const Eigen::Vector2d t = pose.center_map - Eigen::Rotation2Dd(pose.yaw_rad) * center_odom;
  return {t.x(), t.y(), wrap_angle(pose.yaw_rad)};
}

bool is_valid(const Prior& prior) {
  return std::isfinite(prior.T_map_odom.x_m) && std::isfinite(prior.T_map_odom.y_m) &&
         std::isfinite(prior.T_map_odom.yaw_rad) && prior.p_odom_body.allFinite() && prior.cov.allFinite() &&
         (prior.cov.diagonal().array() >= 0.0).all();
}

double largest_position_sigma(const Prior& prior) {
  return std::sqrt(std::max(prior.cov(0, 0), prior.cov(1, 1)));
}

SearchWindow search_window(const SearchConfig& config, const Prior& prior, const TerrainTemplate& terrain) {
  const double sigma_m = largest_position_sigma(prior), sigma_rad = std::sqrt(prior.cov(2, 2));
  SearchWindow window;
  window.prior = {transformed(prior.T_map_odom, terrain.center_odom), prior.T_map_odom.yaw_rad};
  window.half_width_rad = std::clamp(config.sigmas * sigma_rad, config.min_half_width_rad, config.max_half_width_rad);
  // A yaw error about the rover displaces the template's centre.
  const double arm_m = (terrain.center_odom - prior.p_odom_body).norm();
  window.half_width_m = std::clamp(config.sigmas * sigma_m, config.min_half_width_m, config.max_half_width_m) +
                        arm_m * std::sin(window.half_width_rad);
  window.yaw_step_rad = config.yaw_step_rad;
  window.min_overlap = config.min_overlap;
  return window;
}

bool at_border(const SearchWindow& window, const CandidatePose& found) {
  const Eigen::Array2d off = (found.center_map - window.prior.center_map).array().abs();
  return off.maxCoeff() >= window.half_width_m ||
         std::abs(found.yaw_rad - window.prior.yaw_rad) >= window.half_width_rad;
}

// The residual can have several local minima between two yaw steps, so neighbouring yaws are refined too.
void refine_adjacent_yaws(const OrbitalSection& orbital, const TerrainTemplate& terrain, int min_compared,
                          const GlobalConfig& config, Match& best) {
  const CandidatePose found = best.pose;
  for (const double yaw_offset : {-0.75, -0.375, 0.375, 0.75}) {
    const CandidatePose adjacent{found.center_map, found.yaw_rad + yaw_offset * config.search.yaw_step_rad};
    const Match match = refine(orbital, terrain, adjacent, min_compared, config.refinement);
    if (match.fit.compared >= min_compared && match.fit.residual < best.fit.residual) best = match;
  }
}

int min_compared(const TerrainTemplate& terrain, double min_overlap) {
  return static_cast<int>(std::ceil(min_overlap * static_cast<double>(terrain.samples.size())));
}

void sort_by_residual(std::vector<Match>& matches) {
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& a, const Match& b) { return a.fit.residual < b.fit.residual; });
}

void remove_duplicates_of_best(std::vector<Match>& matches, const Eigen::Matrix2d& located, double distance_m) {
  const auto same = [&](const Match& other) {
    return (located * (other.pose.center_map - matches.front().pose.center_map)).norm() < distance_m;
  };
  if (!matches.empty()) matches.erase(std::remove_if(matches.begin() + 1, matches.end(), same), matches.end());
}

// Refined peaks of the correlation by increasing residual.
std::vector<Match> refined_peaks(const OrbitalSection& orbital, const TerrainTemplate& terrain,
                                 const SearchWindow& window, double min_distance_m, int max_peaks,
                                 const RefinementConfig& config) {
  const int least = min_compared(terrain, window.min_overlap);
  std::vector<Match> matches;
  for (const Peak& peak : find_peaks(orbital, terrain, window, min_distance_m, max_peaks)) {
    const Match match = refine(orbital, terrain, peak.pose, least, config);
    if (match.fit.compared >= least) matches.push_back(match);
  }
  sort_by_residual(matches);
  return matches;
}

// After the Gaussian filter, noise is correlated over an area of 4 pi sigma^2.
double independent_samples(const TerrainTemplate& terrain, double sigma_m) {
  return std::max(1.0, terrain.area_m2() / (4.0 * kPi * sigma_m * sigma_m));
}

struct Verdict {
  bool similar;        // the best match, to the ground seen from orbit
  int similar_places;  // too similar to decide between, the best included
};

Verdict judge_relief(const AcceptanceConfig& limits, const std::vector<Match>& matches) {
  const Fit& best = matches.front().fit;
  const auto places = std::count_if(matches.begin(), matches.end(), [&](const Match& other) {
    return limits.max_residual_ratio * other.fit.residual < best.residual;
  });
  return {best.correlation >= limits.min_score && best.residual <= limits.max_residual_m, static_cast<int>(places)};
}

// `lead`: by which the best correlation must exceed others, and none at all.
Verdict judge_picture(double lead, const std::vector<Match>& matches) {
  const Fit& best = matches.front().fit;
  const auto places = std::count_if(matches.begin(), matches.end(), [&](const Match& other) {
    return best.correlation - other.fit.correlation < lead;
  });
  return {best.correlation >= lead, static_cast<int>(places)};
}

// What correlation chance gives: rms at places of the window that are not the best one, on a lattice.
double chance_correlation(const OrbitalSection& orbital, const TerrainTemplate& terrain, const SearchWindow& window,
                          const CandidatePose& best, double min_distance_m) {
  const double step_m = 2.0 * window.half_width_m / (kChanceSide - 1);
  double squares = 0.0;
  int count = 0;
  for (int j = 0; j < kChanceSide; ++j)
    for (int i = 0; i < kChanceSide; ++i) {
      const Eigen::Vector2d offset(i * step_m - window.half_width_m, j * step_m - window.half_width_m);
      const CandidatePose place{window.prior.center_map + offset, best.yaw_rad};
      if ((place.center_map - best.center_map).norm() < min_distance_m) continue;
      const Fit fit = orbital.fit(terrain, place);
      if (fit.compared < min_compared(terrain, window.min_overlap)) continue;
      squares += fit.correlation * fit.correlation;
      ++count;
    }
  return count > 0 ? std::sqrt(squares / count) : 1.0;
}

// Propagates the covariance (x, y, yaw) from the template's centre to the body.
Eigen::Matrix3d covariance_at_body(const Eigen::Matrix3d& cov, const Eigen::Vector2d& arm_map) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -arm_map.y();
  J(1, 2) = arm_map.x();
  return J * cov * J.transpose();
}

// Principal axes of the position, the most certain first.
Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal_axes(const Eigen::Matrix3d& cov) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(cov.topLeftCorner<2, 2>());
}

// Of the position, along the axes that `located` projects on.
double largest_sigma(const Eigen::Matrix3d& cov, const Eigen::Matrix2d& located = Eigen::Matrix2d::Identity()) {
  if (!cov.allFinite()) return kNaN;
  const Eigen::Matrix2d position = located * cov.topLeftCorner<2, 2>() * located;
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(position).eigenvalues()(1));
}

// A fix along one axis: nothing is known across it and of yaw, so the prior's are kept.
void restrict_to_axis(const Eigen::Matrix2d& located, const Prior& prior, const SearchWindow& window, Correction& out) {
  const Eigen::Vector2d p_prior = transformed(prior.T_map_odom, prior.p_odom_body);
  const Eigen::Vector2d p = p_prior + located * (transformed(out.T_map_odom, prior.p_odom_body) - p_prior);
  const double yaw_rad = prior.T_map_odom.yaw_rad;
  const Eigen::Vector2d t = p - Eigen::Rotation2Dd(yaw_rad) * prior.p_odom_body;
  out.T_map_odom = {t.x(), t.y(), yaw_rad};
  const Eigen::Matrix2d position = out.cov.topLeftCorner<2, 2>(), across = Eigen::Matrix2d::Identity() - located;
  out.cov.setZero();
  out.cov.topLeftCorner<2, 2>() = located * position * located + window.half_width_m * window.half_width_m * across;
  out.cov(2, 2) = window.half_width_rad * window.half_width_rad;
}

// Squared Mahalanobis distance of the correction under prior plus match covariance (NIS).
double normalised_innovation_squared(const SearchConfig& config, const Prior& prior, const Correction& found) {
  const Eigen::Vector2d moved =
      transformed(found.T_map_odom, prior.p_odom_body) - transformed(prior.T_map_odom, prior.p_odom_body);
  const Eigen::Vector3d innovation(moved.x(), moved.y(),
                                   wrap_angle(found.T_map_odom.yaw_rad - prior.T_map_odom.yaw_rad));
  const Eigen::Array3d min_half_width(config.min_half_width_m, config.min_half_width_m, config.min_half_width_rad);
  Eigen::Matrix3d expected = prior.cov + found.cov;
  expected.diagonal() = expected.diagonal().array().max((min_half_width / config.sigmas).square());
  return innovation.dot(expected.inverse() * innovation);
}

}  // namespace

bool is_lost(const SearchConfig& config, const Prior& prior) {
  return config.sigmas * largest_position_sigma(prior) > config.min_half_width_m;
}

GlobalLocalization::GlobalLocalization(const GlobalConfig& config, OrbitalMap orbital, double local_cell_m,
                                       std::optional<OrbitalMap> picture)
    : config_(config),
      relief_{Layer::kHeight, std::move(orbital), {config.mosaic_side_m, local_cell_m}, config.filter} {
  if (!picture) return;
  const PictureConfig& c = config.picture;
  picture_.emplace(Source{Layer::kPicture, std::move(*picture), {c.mosaic_side_m, local_cell_m}, c.filter});
}

void GlobalLocalization::add_elevation(const ElevationView& view, const Eigen::Vector2d& p_odom_body) {
  relief_.mosaic.add(view.lattice, view.z_m, view.sigma_m, p_odom_body, config_.max_height_sigma_m);
  if (picture_)
    picture_->mosaic.add(view.lattice, view.brightness, view.sigma_m, p_odom_body, config_.max_height_sigma_m);
}

void GlobalLocalization::clear_local_map() {
  relief_.mosaic.clear();
  if (picture_) picture_->mosaic.clear();
}

Correction GlobalLocalization::correct(const Prior& prior) const {
  if (!is_valid(prior)) {
    Correction out;
    out.reason = "invalid pose";
    return out;
  }
  Correction by_relief = correct_by_relief(prior);
  const bool located = by_relief.accepted && by_relief.axes == 2;
  // Pictures show too many similar places to a lost rover.
  if (located || !picture_ || is_lost(config_.search, prior)) return by_relief;
  try {
    const Correction by_picture = correct_by_picture(prior);
    if (by_picture.accepted) return by_picture;
    by_relief.picture_reason = by_picture.reason;
  } catch (const std::runtime_error&) {  // damaged where the rover comes only now; relief does without it
    by_relief.picture_reason = "orbital picture cannot be read";
  }
  return by_relief;
}

Correction GlobalLocalization::correct_by_picture(const Prior& prior) const {
  Correction out;
  out.layer = Layer::kPicture;
  out.axes = 2;
  const TerrainTemplate ground = template_of(*picture_, 1);
  out.area_m2 = ground.area_m2();
  if (out.area_m2 < config_.acceptance.min_area_m2) {
    out.reason = "local picture too small";
  } else {
    SearchWindow window = search_window(config_.search, prior, ground);
    window.yaw_step_rad = config_.picture.yaw_step_rad;
    window.max_samples = config_.picture.max_samples;
    match(*picture_, prior, ground, window, Eigen::Vector2d::UnitX(), out);
  }
  out.accepted = out.reason.empty();
  return out;
}

Correction GlobalLocalization::correct_by_relief(const Prior& prior) const {
  Correction out;
  const TerrainTemplate terrain = template_of(relief_, 1);
  out.area_m2 = terrain.area_m2();
  const Eigen::Matrix3d expected =
      covariance_at_body(noise_density() * expected_covariance(terrain), prior.p_odom_body - terrain.center_odom);
  const auto principal = principal_axes(expected);
  out.expected_sigma_m = largest_sigma(expected);
  out.expected_sigma_rad = std::sqrt(expected(2, 2));
  const double limit_m = config_.acceptance.max_expected_sigma_cells * relief_.orbital.lattice().cell_m;
  // A fix along one axis does not find a lost rover, and in a wide window other ridges are similar.
  const bool along_one = principal.eigenvalues()(0) <= limit_m * limit_m && !is_lost(config_.search, prior);
  out.axes = featured(out) ? 2 : along_one ? 1 : 0;
  if (out.area_m2 < config_.acceptance.min_area_m2) {
    out.reason = kMapTooSmall;
  } else if (out.axes == 0) {
    out.reason = "not enough relief";
  } else {
    match(relief_, prior, terrain, search_window(config_.search, prior, terrain), principal.eigenvectors().col(0), out);
  }
  out.accepted = out.reason.empty();
  return out;
}

// At the resolution of blocks of n x n cells of the orbital map, and blurred like them.
TerrainTemplate GlobalLocalization::template_of(const Source& source, int n) const {
  PlaneConfig filter = source.filter;
  filter.sigma_cells = std::hypot(filter.sigma_cells, config_.map_blur_cells / n);
  const HeightGrid local = source.mosaic.resampled(n * source.orbital.lattice().cell_m);
  TerrainTemplate terrain = terrain_template(local, filter, source.layer);
  terrain.drift_information = drift_information(terrain, config_.height_drift, noise_density());
  return terrain;
}

// Noise power density of the orbital heights [m^4].
double GlobalLocalization::noise_density() const {
  const double side_m = config_.map_noise_cells * relief_.orbital.lattice().cell_m;
  return config_.map_noise_m * config_.map_noise_m * side_m * side_m;
}

bool GlobalLocalization::featured(const Correction& c) const {
  const AcceptanceConfig& limits = config_.acceptance;
  return c.area_m2 >= limits.min_area_m2 &&
         c.expected_sigma_m <= limits.max_expected_sigma_cells * relief_.orbital.lattice().cell_m &&
         c.expected_sigma_rad <= limits.max_expected_sigma_rad;
}

// The whole window at the orbital map's resolution.
GlobalLocalization::Candidates GlobalLocalization::search(const Source& source, const SearchWindow& window,
                                                          const TerrainTemplate& terrain) const {
  const double reach_m = std::sqrt(2.0) * window.half_width_m + terrain.radius_m;
  Candidates found{{}, orbital_section(source, window.prior.center_map, reach_m, 1)};
  found.matches = refined_peaks(found.section, terrain, window, config_.search.min_peak_distance_m,
                                config_.search.max_peaks, config_.refinement);
  return found;
}

// The window in blocks of n x n cells, and the best places there at the orbital map's resolution.
GlobalLocalization::Candidates GlobalLocalization::search_coarse_to_fine(const Source& source,
                                                                         const SearchWindow& window,
                                                                         const TerrainTemplate& terrain, int n) const {
  const TerrainTemplate coarse = template_of(source, n);
  SearchWindow around = window;
  around.prior.center_map = transformed(transform_of(window.prior, terrain.center_odom), coarse.center_odom);
  const double reach_m = std::sqrt(2.0) * window.half_width_m + coarse.radius_m;
  std::vector<Match> places =
      refined_peaks(orbital_section(source, around.prior.center_map, reach_m, n), coarse, around,
                    n * config_.search.min_peak_distance_m, kCoarsePeaks, config_.refinement);
  if (static_cast<int>(places.size()) > config_.search.max_peaks) places.resize(config_.search.max_peaks);
  RefinementConfig refinement = config_.refinement;
  refinement.half_width_cells *= n;
  const int least = min_compared(terrain, window.min_overlap);
  Candidates found;
  for (const Match& place : places) {
    const CandidatePose start{transformed(transform_of(place.pose, coarse.center_odom), terrain.center_odom),
                              place.pose.yaw_rad};
    const double cells = 2.0 * refinement.half_width_cells;
    OrbitalSection section =
        orbital_section(source, start.center_map, terrain.radius_m + cells * source.orbital.lattice().cell_m, 1);
    const Match match = refine(section, terrain, start, least, refinement);
    if (match.fit.compared < least) continue;
    if (found.matches.empty() || match.fit.residual < found.matches.front().fit.residual)
      found.section = std::move(section);
    found.matches.push_back(match);
    sort_by_residual(found.matches);
  }
  return found;
}

void GlobalLocalization::match(const Source& source, const Prior& prior, const TerrainTemplate& terrain,
                               const SearchWindow& window, const Eigen::Vector2d& axis_odom, Correction& out) const {
  const AcceptanceConfig& limits = config_.acceptance;
  const double cells = 2.0 * window.half_width_m / source.orbital.lattice().cell_m;
  const int n = static_cast<int>(std::ceil(cells / config_.search.max_cells));
  auto [matches, orbital] = n > 1 ? search_coarse_to_fine(source, window, terrain, n) : search(source, window, terrain);
  if (matches.empty()) {
    out.reason = "no similar terrain on the orbital map";
    return;
  }
  refine_adjacent_yaws(orbital, terrain, min_compared(terrain, window.min_overlap), config_, matches.front());
  const Eigen::Vector2d axis = Eigen::Rotation2Dd(matches.front().pose.yaw_rad) * axis_odom;
  const Eigen::Matrix2d located =
      out.axes == 2 ? Eigen::Matrix2d::Identity() : Eigen::Matrix2d(axis * axis.transpose());
  remove_duplicates_of_best(matches, located, 0.5 * config_.search.min_peak_distance_m);
  const Match& best = matches.front();
  out.T_map_odom = transform_of(best.pose, terrain.center_odom);
  out.score = best.fit.correlation;
  out.residual = best.fit.residual;
  if (matches.size() > 1) {
    out.second_score = matches[1].fit.correlation;
    out.second_residual = matches[1].fit.residual;
  }
  const double independent = independent_samples(terrain, source.filter.sigma_cells * source.orbital.lattice().cell_m);
  const double apart_m = config_.search.min_peak_distance_m;
  const Verdict verdict =
      source.layer == Layer::kHeight
          ? judge_relief(limits, matches)
          : judge_picture(config_.picture.min_sigmas * chance_correlation(orbital, terrain, window, best.pose, apart_m),
                          matches);
  out.similar_places = verdict.similar_places;
  const Eigen::Matrix3d cov = covariance_at_minimum(orbital, terrain, best, independent, window.half_width_m);
  out.sigma_m = largest_sigma(cov, located);
  Eigen::Matrix3d R_map_odom = Eigen::Matrix3d::Identity();
  R_map_odom.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(best.pose.yaw_rad).toRotationMatrix();
  const Eigen::Matrix3d distortion = R_map_odom *
                                     distortion_covariance(terrain, config_.map_sigma_m, config_.map_sigma_length_m) *
                                     R_map_odom.transpose();
  // A rotation about the matched terrain displaces the body by the lever arm.
  const Eigen::Vector2d arm = transformed(out.T_map_odom, prior.p_odom_body) - best.pose.center_map;
  out.cov = covariance_at_body(cov + distortion, arm);
  const double body_sigma_m = largest_sigma(out.cov, located);
  // The last fix saw the same distortion on the terrain that both share, so only what is new adds information.
  const double shared = std::max(1.0, 2.0 * terrain.radius_m / std::max(prior.since_fix_m, kMinSinceFixM));
  out.cov += (shared - 1.0) * covariance_at_body(distortion, arm);
  const bool yaw_certain = out.axes == 1 || cov(2, 2) <= limits.max_sigma_rad * limits.max_sigma_rad;
  if (out.axes == 1) restrict_to_axis(located, prior, window, out);

  if (!verdict.similar) {
    out.reason = "best match not similar enough";
  } else if (out.similar_places > 1) {
    out.reason = "ambiguous: other places are almost as similar";
  } else if (at_border(window, best.pose)) {
    out.reason = "best match at the border of the search window";
  } else if (!(out.sigma_m <= limits.max_sigma_m && yaw_certain)) {
    out.reason = "match too uncertain";
  } else if (!(body_sigma_m <= limits.max_body_sigma_m)) {
    out.reason = "too far from the matched terrain";
  } else if (normalised_innovation_squared(config_.search, prior, out) > limits.gate_chi2) {
    out.reason = "innovation larger than the pose's covariance allows";
  }
}

// Filters only the search area, because the orbital map can be large.
OrbitalSection GlobalLocalization::orbital_section(const Source& source, const Eigen::Vector2d& center_map,
                                                   double half_width_m, int n) const {
  const double margin_m = (3.0 * source.filter.sigma_cells + 4.0) * n * source.orbital.lattice().cell_m;
  const HeightGrid grid = source.orbital.around(center_map, half_width_m + margin_m, n);
  return OrbitalSection(field_of(source.layer, grid, source.filter));
}

}  // namespace rover::global
