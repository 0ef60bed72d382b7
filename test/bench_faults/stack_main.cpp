// Part `stack` of ./rover bench faults: injects every row of config/fdir.yaml repeatedly into one long-lived stack, and
// records it for the judge.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "common/bus/vehicle_config.hpp"
#include "supervisor/config.hpp"
#include "supervisor/node.hpp"
#include "test/bench_faults/injector.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "tools/one_process/services.hpp"

namespace rover::bench_faults {
namespace {

struct Arguments {
  std::string config = "config";
  std::string out = "logs/bench/faults/stack";
  std::uint64_t seed = 1;
  int per_row = 24;
  size_t most = 100'000;
  std::vector<std::string> rows;  // of fdir.yaml; empty: all
};

std::vector<Case> cases_of(const std::vector<std::string>& rows) {
  std::vector<Case> cases = all_cases();
  if (!rows.empty())
    std::erase_if(cases, [&](const Case& c) { return std::find(rows.begin(), rows.end(), c.row) == rows.end(); });
  return cases;
}

class Bench {
 public:
  explicit Bench(const Arguments& arguments)
      : arguments_(arguments),
        vehicle_(load_vehicle(arguments.config)),
        field_(arguments.seed),
        rover_(vehicle_, arguments.seed),
        view_(synthetic::loccam_camera(), -vehicle_.origin_height_m),
        log_(bus_, arguments.out + "/stack.lcm"),
        seen_(bus_),
        ground_(bus_, seen_, rover_, field_, arguments.seed),
        stack_(bus_, arguments.out, true),
        hands_(bus_, rover_, blindness_, stack_, ground_),
        cases_(cases_of(arguments.rows)),
        injector_(cases_, arguments.per_row, arguments.most,
                  vehicle_.footprint_half_length_m() + supervisor::load_config(arguments.config).stop_distance_m, seen_,
                  hands_, field_, log_, arguments.seed) {
    add_stand_ins();
    add_services();
    bus_.subscribeFunction(
            channel::kWheelCommand,
            +[](const lcm::ReceiveBuffer*, const std::string&, const wheel_command_t* m, Bench* self) {
              self->commanded_ = *m;
            },
            this)
        ->setQueueCapacity(0);
  }

  void run() {
    while (!injector_.done() && !injector_.lost()) tick();
    std::printf("%zu injections in %.0f s of message time, %d stuck\n", injector_.count(), to_seconds(now_),
                injector_.stuck());
  }

 private:
  static constexpr double kRestartS = 1.0;  // restart delay in a lockstep run

  void add_stand_ins() {
    stack_.add("stereo", [this](Node& n) { return make_stereo(n, rover_, field_, view_, blindness_); });
    stack_.add("visual_odometry", [this](Node& n) { return make_visual_odometry(n, rover_, blindness_); });
    stack_.add("traversability", make_traversability);
    stack_.add("slam", [this](Node& n) { return make_slam(n, blindness_); });
    for (const char* name : {"point_cloud", "pan_tilt", "global_localization", "recorder", "mission_control"})
      stack_.add(name, make_silent);
  }

  void add_services() {
    for (const char* name : {"localization", "hazard_detector", "path_planner", "trajectory_control", "locomotion"})
      stack_.add(name, service_factory(name, arguments_.config));
    supervisor::SupervisorConfig core = supervisor::load_config(arguments_.config);
    core.level.linger_s = 1e6;  // the rows of idle services are judged too
    stack_.add("supervisor", [this, core](Node& n) {
      return std::make_shared<supervisor::SupervisorNode>(n, core, [this](const std::string& who, const char* option) {
        if (std::string_view(option) != "-k") return false;
        injection_t note{};
        note.target = who;
        log_.note(kKillOrdered, note);
        stack_.kill(who, kRestartS);
        return true;
      });
    });
  }

  void tick() {
    now_ += kTickUs + hands_.clock_step;
    hands_.clock_step = 0;
    log_.set_time(now_);
    if (commanded_.header.release_utime <= now_) rover_.command(commanded_);
    rover_.step(now_);
    publish(channel::kImu, rover_.imu());
    publish(channel::kWheelState, rover_.wheels());
    publish(channel::kTruth, rover_.truth());
    ground_.set_time(now_);
    if (!injector_.injecting()) ground_.step();
    injector_.step(now_);
    stack_.tick(now_);
  }

  template <class Message>
  void publish(const char* channel, Message message) {
    message.header = sensors_.next(channel, now_, now_);
    bus_.publish(channel, &message);
  }

  Arguments arguments_;
  lcm::LCM bus_{"memq://"};
  Utime now_ = 0;
  Vehicle vehicle_;
  Field field_;
  StandInRover rover_;
  View view_;
  Blindness blindness_;
  Log log_;
  Observer seen_;
  Ground ground_;
  Stack stack_;
  Hands hands_;
  std::vector<Case> cases_;
  Injector injector_;
  StreamCounter sensors_{"rover_simulator", 1};
  wheel_command_t commanded_{};
};

}  // namespace
}  // namespace rover::bench_faults

int main(int argc, char** argv) {
  rover::bench_faults::Arguments arguments;
  CLI::App app("injects every row of config/fdir.yaml into a stack in one process");
  app.add_option("--config", arguments.config, "configuration folder")->capture_default_str();
  app.add_option("--out", arguments.out, "folder of the log")->capture_default_str();
  app.add_option("--seed", arguments.seed)->capture_default_str();
  app.add_option("--per-row", arguments.per_row, "injections of each row")->capture_default_str();
  app.add_option("--rows", arguments.rows, "only these rows")->delimiter(',');
  app.add_option("--most", arguments.most, "maximum number of injections");
  CLI11_PARSE(app, argc, argv);
  std::filesystem::remove_all(arguments.out);
  std::filesystem::create_directories(arguments.out);
  rover::bench_faults::Bench(arguments).run();
  return 0;
}
