// rover_orbital_planner MAP --start X,Y --goal X,Y: global path and levels of autonomy from an orbital map.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <opencv2/core.hpp>

#include "common/bus/command_line.hpp"
#include "tools/orbital_planner/command.hpp"
#include "tools/orbital_planner/config.hpp"

int main(int argc, char** argv) {
  rover::orbital::Arguments arguments;
  CLI::App app(
      "Globally optimal path on an orbital map, with the level of autonomy of each segment.\n"
      "Example: ./rover plan config/terrain/gale/gale_hirise_dtm_1m_348x337.tif --start 96,262 --goal 118,255");
  app.name("./rover plan");
  app.add_option("map", arguments.map, "elevation model with georeference, any format that GDAL reads")
      ->required()
      ->transform(rover::is_user_path());
  app.add_option("--start", arguments.start, "X,Y in metres from the map's lower left corner")->required();
  rover::repeatable(app.add_option("--via", arguments.via, "an intermediate waypoint, repeatable"));
  app.add_option("--goal", arguments.goal, "as --start")->required();
  app.add_flag("--lonlat", arguments.lon_lat, "places are LONGITUDE,LATITUDE in degrees instead (--start=-9.5,4.1)");
  app.add_option("--zones", arguments.zones,
                 "GeoJSON polygons, in the coordinates of the places, that the path keeps out of; with the property "
                 "\"kind\": \"keep_in\" it does not leave them")
      ->transform(rover::is_user_path());
  app.add_option("--out", arguments.out, "folder for the results, new or empty; default: logs/<time>-plan-<map>")
      ->transform(rover::is_user_path());
  app.add_option("--config", arguments.config_dir, "folder with orbital_planner.yaml and navigation.yaml")
      ->capture_default_str()
      ->transform(rover::is_user_path());
  const auto print_parameters = [&](const std::string& format) {
    rover::ParameterList list;
    rover::orbital::load_config(arguments.config_dir, &list);
    std::fputs(rover::to_format(list, format).c_str(), stdout);
    throw CLI::Success();
  };
  app.add_option_function<std::string>("--parameters", print_parameters,
                                       "print all parameters with their defaults and exit")
      ->check(CLI::IsMember({"text", "yaml", "markdown"}))
      ->trigger_on_parse();
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  cv::setNumThreads(1);
  try {
    std::fputs(rover::orbital::run(arguments).c_str(), stdout);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rover plan: %s\n", error.what());
    return 2;
  }
  return 0;
}
