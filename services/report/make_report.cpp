#include "report/make_report.hpp"

#include <fmt/format.h>

#include "report/html.hpp"
#include "report/log_reader.hpp"
#include "report/map_layers.hpp"
#include "report/map_picture.hpp"
#include "report/metrics_json.hpp"
#include "report/no_truth.hpp"
#include "report/rasterise.hpp"
#include "report/run_folder.hpp"
#include "report/run_plots.hpp"
#include "report/world_truth.hpp"

namespace rover::report {
namespace {

constexpr double kAroundM = 15.0;  // of the track and the planned path: what the map shows and the cameras see
constexpr double kPngScale = 1.0;

Box surroundings(const RunRecord& run) {
  Points track;
  for (const TruthSample& sample : run.truth) track.emplace_back(sample.T_map_body.translation().head<2>());
  std::vector<Points> lines{track};
  for (const PathRecord& path : run.global_paths) lines.push_back(path.points);
  return bounds(lines).grown(kAroundM);
}

Pictures draw(const Scene& scene) {
  Pictures pictures;
  pictures.map = draw_map(scene);
  for (size_t i = 0; i < scene.judgement.incidents.size(); ++i) pictures.incidents.push_back(draw_incident(scene, i));
  pictures.states = draw_state_timeline(scene);
  const PlotMarks marks = incident_marks(scene);
  const double distance_m = scene.judgement.metrics.driven_length_m;
  const std::vector<Plot> plots = run_plots(scene);
  for (size_t i = 0; i < plots.size(); ++i)
    pictures.plots.push_back(draw_plot(plots[i], marks, distance_m, fmt::format("plot-{}", i)));
  return pictures;
}

}  // namespace

std::string write_report(const RunFolder& folder, const RunRecord& recorded, const std::optional<TrueWorld>& world,
                         const HeightRaster& orbital) {
  const bool true_run = !recorded.truth.empty();
  const RunRecord estimated = true_run ? RunRecord{} : with_estimate_for_truth(recorded);
  const RunRecord& run = true_run ? recorded : estimated;
  Judgement judgement = judge(run, folder.info, folder.footprint, world);
  if (!true_run) leave_out_truth_figures(judgement.metrics);
  write_file(folder.dir + "/metrics.json", metrics_json(judgement.metrics).dump(2) + "\n");
  const Scene scene{run, judgement, folder.footprint, orbital, world};
  const Pictures pictures = draw(scene);
  write_file(folder.dir + "/traverse.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + pictures.map);
  write_png(pictures.map, kPngScale, folder.dir + "/traverse.png");
  write_file(folder.dir + "/report.html", report_html(scene, pictures, configuration_texts(folder)));
  const Metrics& m = judgement.metrics;
  return fmt::format("{}: {}, {:.1f} m driven of {:.1f} m planned, {} repairs, {}", folder.dir, m.outcome,
                     m.driven_length_m, m.planned_length_m, m.replans,
                     has_truth(m) ? fmt::format("{} collisions", m.collisions) : "no truth");
}

std::string make_report(const std::string& run_dir, const std::string& default_config_dir) {
  const RunFolder folder = open_run_folder(run_dir, default_config_dir);
  const RunRecord run = read_log(folder.log, folder.info.sim_s);
  return write_report(folder, run, load_true_world(folder, surroundings(run)), load_orbital_map(folder));
}

}  // namespace rover::report
