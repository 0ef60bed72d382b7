// Disparities of rendered images beside geometric ones at the same poses: what DisparityErrors is fitted to.
// perception_study --camera loccam|navcam: a table of errors by depth; --picture: histograms of the errors.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "common/bus/vehicle_config.hpp"
#include "common/stereo/stereo.hpp"
#include "point_cloud/config.hpp"
#include "rover_simulator/camera/geometric_view.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "stereo/config.hpp"
#include "tools/report/rasterise.hpp"
#include "tools/report/svg.hpp"

namespace rover {
namespace {

constexpr int kBorder = 12;     // pixels at the border are left out
constexpr int kEdgeWindow = 6;  // half side of the window of an edge
constexpr float kEdgePx = 4.0F;
constexpr double kOutlierPx = 1.5;
constexpr long kMinPixels = 5000;  // at a depth, to be shown
constexpr double kHistogramPx = 0.1;
constexpr int kHistogramBins = 31;

struct Arguments {
  std::string config = ROVER_SOURCE_DIR "/config";
  std::string scenario = ROVER_SOURCE_DIR "/config/scenarios/full_hard.yaml";
  std::string camera = "loccam";
  std::string picture;  // PNG of the histograms
  std::string dump;     // folder for pictures of the first frames
  std::uint64_t first_seed = 11;
  int seeds = 3;
  int poses = 10;
};

// Errors of the pixels at one depth.
struct Errors {
  long count = 0;
  long invalid = 0;
  long outliers = 0;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  std::array<long, kHistogramBins> histogram{};

  void add(const Disparity& disparity, int u, int v, float exact_px) {
    ++count;
    if (!disparity.valid(u, v)) {
      ++invalid;
      return;
    }
    const double error = disparity.px(u, v) - exact_px;
    const int bin = static_cast<int>(std::lround(error / kHistogramPx)) + kHistogramBins / 2;
    ++histogram[static_cast<size_t>(std::clamp(bin, 0, kHistogramBins - 1))];
    if (std::abs(error) > kOutlierPx) {
      ++outliers;
      return;
    }
    sum += error;
    sum_of_squares += error * error;
  }
  double inliers() const { return static_cast<double>(count - invalid - outliers); }
  double bias() const { return sum / inliers(); }
  double sigma() const { return std::sqrt(sum_of_squares / inliers() - bias() * bias()); }
  double of_all(long part) const { return 100.0 * static_cast<double>(part) / static_cast<double>(count); }
};

struct Key {
  bool edge;
  int half_metres;
  auto operator<=>(const Key&) const = default;
};
using Table = std::map<Key, std::array<Errors, 2>>;  // rendered, geometric

// The body on the ground under its six wheels, rocks left out.
Eigen::Isometry3d place(const World& world, const Pose2& at, double origin_height_m) {
  const double c = std::cos(at.yaw_rad);
  const double s = std::sin(at.yaw_rad);
  const auto ground = [&](double x, double y) {
    return world.ground_height_m(at.x_m + c * x - s * y, at.y_m + s * x + c * y);
  };
  const double pitch = std::atan2(ground(-0.75, 0.0) - ground(0.75, 0.0), 1.5);
  const double roll = std::atan2(ground(0.0, 0.41) - ground(0.0, -0.41), 0.82);
  const Eigen::Matrix3d R = rotation_from_rpy(roll, pitch, at.yaw_rad);
  return make_pose(R, Eigen::Vector3d(at.x_m, at.y_m, ground(0.0, 0.0)) + origin_height_m * R.col(2));
}

bool at_edge(const std::vector<float>& exact_px, int width, int u, int v) {
  float low = 1e9F;
  float high = 0.0F;
  for (int j = -kEdgeWindow; j <= kEdgeWindow; j += kEdgeWindow / 2)
    for (int i = -kEdgeWindow; i <= kEdgeWindow; i += kEdgeWindow / 2) {
      const float px = exact_px[static_cast<size_t>(v + j) * width + u + i];
      low = std::min(low, px);
      high = std::max(high, px);
    }
  return high - low > kEdgePx;
}

void dump(const std::string& file, const stereo::StereoResult& rendered, const std::vector<float>& exact_px,
          const Disparity& geometric) {
  const int width = geometric.width;
  const int height = geometric.height;
  cv::Mat out(2 * height, 2 * width, CV_8UC3);
  const auto grey = [](double px) {
    const auto g = static_cast<std::uint8_t>(std::clamp(3.0 * px, 0.0, 255.0));
    return cv::Vec3b(g, g, g);
  };
  const auto error = [&](const Disparity& d, int u, int v) {
    if (!d.valid(u, v)) return cv::Vec3b(0, 0, 200);
    const double e = 60.0 * (d.px(u, v) - exact_px[static_cast<size_t>(v) * width + u]);
    return cv::Vec3b(cv::saturate_cast<std::uint8_t>(128 + e), 128, cv::saturate_cast<std::uint8_t>(128 - e));
  };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::uint8_t image = rendered.left.at(u, v);
      out.at<cv::Vec3b>(v, u) = cv::Vec3b(image, image, image);
      out.at<cv::Vec3b>(v, u + width) = grey(exact_px[static_cast<size_t>(v) * width + u]);
      out.at<cv::Vec3b>(v + height, u) = error(rendered.disparity, u, v);
      out.at<cv::Vec3b>(v + height, u + width) = error(geometric, u, v);
    }
  cv::imwrite(file, out);
}

void print(const Table& table) {
  std::printf(
      "| ground | depth m | pixels | invalid %% | outliers %% | bias px | sigma px |\n|---|---|---|---|---|---|---|\n");
  for (const auto& [key, errors] : table) {
    const auto& [rendered, geometric] = errors;
    if (rendered.count < kMinPixels || key.half_metres > 24) continue;
    std::printf("| %s | %.1f | %ld | %.1f / %.1f | %.2f / %.2f | %.3f / %.3f | %.3f / %.3f |\n",
                key.edge ? "edge" : "smooth", 0.5 * key.half_metres, rendered.count, rendered.of_all(rendered.invalid),
                geometric.of_all(geometric.invalid), rendered.of_all(rendered.outliers),
                geometric.of_all(geometric.outliers), rendered.bias(), geometric.bias(), rendered.sigma(),
                geometric.sigma());
  }
}

// One panel for each depth, smooth ground above and edges below: rendered as an area, geometric as a line.
std::string draw_histograms(const Table& table, int panels) {
  constexpr double kPanel = 150.0;
  constexpr double kTop = 40.0;
  report::Svg svg(panels * kPanel + 20.0, 2 * kPanel + kTop + 20.0);
  svg.rect(0, 0, panels * kPanel + 20.0, 2 * kPanel + kTop + 20.0, "fill:#ffffff");
  svg.text(10, 22, "Error of the disparity by depth: rendered (grey), geometric (line); smooth ground, edges of rocks",
           14, "fill:#333333");
  int first = -1;  // depth of the first panel, in half metres
  for (const auto& [key, errors] : table) {
    if (first < 0 && errors[0].count > kMinPixels) first = key.half_metres;
    const int column = key.half_metres - first;
    if (first < 0 || column < 0 || column >= panels) continue;
    const double left = 10.0 + column * kPanel;
    const double bottom = kTop + (key.edge ? 2.0 : 1.0) * kPanel - 20.0;
    for (size_t tier = 0; tier < 2; ++tier) {
      const double all = errors[tier].inliers() + static_cast<double>(errors[tier].outliers);
      report::Points line = {{left, bottom}};
      for (int bin = 0; bin < kHistogramBins; ++bin) {
        const double share = static_cast<double>(errors[tier].histogram[static_cast<size_t>(bin)]) / std::max(all, 1.0);
        const double y = bottom - std::min(share * 250.0, kPanel - 45.0);
        const double x = left + (kPanel - 15.0) * bin / kHistogramBins;
        line.emplace_back(x, y);
        line.emplace_back(x + (kPanel - 15.0) / kHistogramBins, y);
      }
      line.emplace_back(left + kPanel - 15.0, bottom);
      if (tier == 0)
        svg.polygon(line, "fill:#c8c8c8");
      else
        svg.polyline(line, "fill:none;stroke:#c04020;stroke-width:1.5");
    }
    svg.line(left, bottom, left + kPanel - 15.0, bottom, "stroke:#333333");
    svg.text(left + 2.0, bottom - kPanel + 40.0, fmt::format("{:.1f} m", 0.5 * key.half_metres), 11, "fill:#333333");
    svg.text(left, bottom + 14.0, "-1.5", 10, "fill:#777777");
    svg.text(left + kPanel - 15.0, bottom + 14.0, "1.5 px", 10, "fill:#777777", report::Anchor::kEnd);
  }
  return svg.str();
}

void study(const Arguments& arguments) {
  const Scenario scenario = load_scenario(arguments.scenario);
  const double origin_height_m = load_vehicle(arguments.config).origin_height_m;
  const StereoRig rig = load_stereo_rig(arguments.config, arguments.camera);
  const bool navcam = arguments.camera == "navcam";
  const stereo::StereoConfig matching =
      navcam ? stereo::StereoConfig{.matcher = cloud::load_config(arguments.config).core.matcher}
             : stereo::load_config(arguments.config).core;
  Table table;
  double geometric_s = 0.0;
  for (std::uint64_t seed = arguments.first_seed; seed < arguments.first_seed + arguments.seeds; ++seed) {
    const World world(scenario.world, scenario.dtm, seed);
    CameraSimConfig sim;
    sim.scene.appearance = {
        .sun_elevation_rad = scenario.sun_elevation_rad, .sun_azimuth_rad = scenario.sun_azimuth_rad, .seed = seed};
    StereoCameraSim camera(rig, sim, world, seed);
    stereo::Stereo stereo(matching, rig, origin_height_m);
    GeometricView view(world, sim.scene.appearance);
    GeometricStereo geometric(rig, camera.true_rig(), stereo.camera(), view.scene());
    const DisparityErrors errors(errors_of(matching.matcher, stereo.camera()), rig.width, rig.height, seed);
    const DisparityPlane reference = ground_reference(stereo.camera(), origin_height_m);
    for (int i = 0; i < arguments.poses; ++i) {
      const double f = (i + 0.5) / arguments.poses;
      const Pose2 at{scenario.path.x_m[0] + f * (scenario.path.x_m[1] - scenario.path.x_m[0]),
                     scenario.path.y_m[0] + f * (scenario.path.y_m[1] - scenario.path.y_m[0]), 0.3 * i};
      const Eigen::Isometry3d T_map_left = place(world, at, origin_height_m) * rig.T_body_left;
      const auto pair = camera.render_from(T_map_left, i);
      const auto rendered = stereo.step(pair.left, pair.right);
      const std::vector<float> exact = geometric.exact_px(T_map_left);
      const auto started = std::chrono::steady_clock::now();
      const Disparity modelled = view.expose(geometric, errors, reference, T_map_left, i);
      geometric_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
      for (int v = kBorder; v < rig.height - kBorder; ++v)
        for (int u = kBorder; u < rig.width - kBorder; ++u) {
          const float px = exact[static_cast<size_t>(v) * rig.width + u];
          if (px <= 0.0F) continue;
          const int half_metres = static_cast<int>(2.0 * stereo.camera().depth_m(px));
          auto& errors_at = table[{at_edge(exact, rig.width, u, v), half_metres}];
          errors_at[0].add(rendered->disparity, u, v, px);
          errors_at[1].add(modelled, u, v, px);
        }
      if (!arguments.dump.empty() && i < 4)
        dump(arguments.dump + "/" + arguments.camera + std::to_string(seed) + "-" + std::to_string(i) + ".png",
             *rendered, exact, modelled);
    }
  }
  print(table);
  std::printf("\ngeometric: %.1f ms per frame\n", 1e3 * geometric_s / (arguments.seeds * arguments.poses));
  if (!arguments.picture.empty()) report::write_png(draw_histograms(table, 8), 1.0, arguments.picture);
}

}  // namespace
}  // namespace rover

int main(int argc, char** argv) {
  rover::Arguments arguments;
  CLI::App app("perception_study: rendered beside geometric disparities");
  app.add_option("--config", arguments.config)->capture_default_str();
  app.add_option("--scenario", arguments.scenario)->capture_default_str();
  app.add_option("--camera", arguments.camera)->check(CLI::IsMember({"loccam", "navcam"}))->capture_default_str();
  app.add_option("--seeds", arguments.seeds, "number of worlds")->capture_default_str();
  app.add_option("--first-seed", arguments.first_seed)->capture_default_str();
  app.add_option("--poses", arguments.poses, "in each world")->capture_default_str();
  app.add_option("--picture", arguments.picture, "PNG file of the histograms");
  app.add_option("--dump", arguments.dump, "folder for pictures");
  CLI11_PARSE(app, argc, argv);
  rover::study(arguments);
  return 0;
}
