#include "tools/one_process/services.hpp"

#include <map>

#include "common/bus/vehicle_config.hpp"
#include "common/core/check.hpp"
#include "global_localization/node.hpp"
#include "hazard_detector/node.hpp"
#include "localization/config.hpp"
#include "localization/node.hpp"
#include "locomotion/config.hpp"
#include "locomotion/node.hpp"
#include "mission_control/node.hpp"
#include "pan_tilt/node.hpp"
#include "path_planner/config.hpp"
#include "path_planner/node.hpp"
#include "point_cloud/node.hpp"
#include "recorder/node.hpp"
#include "slam/node.hpp"
#include "stereo/node.hpp"
#include "supervisor/config.hpp"
#include "supervisor/node.hpp"
#include "trajectory_control/config.hpp"
#include "trajectory_control/node.hpp"
#include "traversability/node.hpp"
#include "visual_odometry/config.hpp"
#include "visual_odometry/node.hpp"

namespace rover {
namespace {

using Make = std::shared_ptr<void> (*)(Node& node, const std::string& config_dir);

std::shared_ptr<void> make_mission_control(Node& node, const std::string& config_dir) {
  return std::make_shared<MissionControlNode>(node, load_mission_plan(config_dir),
                                              std::make_shared<mission::SharedState>(),
                                              mission::load_config(config_dir).path);
}

std::shared_ptr<void> make_supervisor(Node& node, const std::string& config_dir) {
  return std::make_shared<supervisor::SupervisorNode>(node, supervisor::load_config(config_dir),
                                                      [](const std::string&, const char*) { return false; });
}

template <class Service, auto load_config>
std::shared_ptr<void> make(Node& node, const std::string& config_dir) {
  return std::make_shared<Service>(node, load_config(config_dir, nullptr));
}

template <auto make_service>
std::shared_ptr<void> made(Node& node, const std::string& config_dir) {
  return make_service(node, config_dir);
}

const std::map<std::string, Make> kServices = {
    {"stereo", made<stereo::make_stereo>},
    {"visual_odometry", make<vo::OdometryNode, vo::load_config>},
    {"localization",
     [](Node& node, const std::string& config_dir) -> std::shared_ptr<void> {
       return std::make_shared<loc::LocalizationNode>(node, loc::load_config(config_dir), load_vehicle(config_dir));
     }},
    {"hazard_detector", made<hazard::make_hazard_detector>},
    {"path_planner", make<planning::PathPlannerNode, planning::load_config>},
    {"trajectory_control", make<control::TrajectoryControlNode, control::load_config>},
    {"locomotion", make<locomotion::LocomotionNode, locomotion::load_config>},
    {"supervisor", make_supervisor},
    {"mission_control", make_mission_control},
    {"recorder", made<recorder::make_recorder>},
    {"point_cloud", made<cloud::make_point_cloud>},
    {"pan_tilt", made<gaze::make_pan_tilt>},
    {"slam", made<slam::make_slam>},
    {"traversability", made<trav::make_traversability>},
    {"global_localization", made<global::make_global_localization>},
};

}  // namespace

Stack::Factory service_factory(const std::string& service, const std::string& config_dir) {
  const auto found = kServices.find(service);
  ROVER_CHECK(found != kServices.end(), service);
  return [make = found->second, config_dir](Node& node) { return make(node, config_dir); };
}

}  // namespace rover
