#include "tools/launcher/replay_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/bus/bus_url.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/service_names.hpp"
#include "common/core/decimal.hpp"
#include "tools/launcher/preflight.hpp"
#include "tools/launcher/run_folder.hpp"
#include "tools/launcher/run_report.hpp"
#include "tools/launcher/s6_tree.hpp"
#include "tools/replay/comparison_text.hpp"
#include "tools/replay/field_difference.hpp"
#include "tools/replay/player.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

using replay::RecordedLog;

// Validated arguments.
struct Plan {
  std::string log_file;
  std::string log_dir;
  std::string name;  // name of the log's folder or file
  std::string config_from;
  std::string bus_url;  // used without live services
  std::vector<std::string> live;
  bool records = false;
  bool injects = false;
  replay::PlayerOptions player;
};

std::string config_from(const ReplayArguments& arguments, const std::string& log_dir) {
  const std::string own = log_dir + "/config";
  std::string dir = arguments.config_dir;
  if (dir.empty()) dir = fs::exists(own + "/vehicle.yaml") ? own : arguments.run.source_dir + "/config";
  if (!fs::is_regular_file(dir + "/bus.yaml")) throw ConfigError(dir + ": contains no configuration (bus.yaml)");
  return dir;
}

std::vector<std::string> publishing_services(const RecordedLog& log) {
  std::vector<std::string> names;
  for (const std::string& name : service_names(true))
    if (name != "recorder" && name != "mission_control" && !replay::boots_of(log, name).empty()) names.push_back(name);
  return names;
}

std::vector<std::string> live_services(const ReplayArguments& arguments, const RecordedLog& log) {
  const bool all = arguments.services == std::vector<std::string>{"all"};
  if (all || (arguments.check && arguments.services.empty())) {
    const std::vector<std::string> names = publishing_services(log);
    if (names.empty())
      throw ConfigError(arguments.log + ": contains no messages of services; select some with --services");
    return names;
  }
  std::vector<std::string> names;
  const std::vector<std::string> services = service_names(true);
  for (const std::string& name : arguments.services) {
    if (std::find(services.begin(), services.end(), name) == services.end()) {
      std::string known;
      for (const std::string& service : services) known += (known.empty() ? "" : ", ") + service;
      throw ConfigError("--services: no service '" + name + "'; known services: " + known);
    }
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

double speed_of(const std::string& text) {
  if (text == "max") return 0.0;
  const auto speed = parse_number(text);
  if (!speed || *speed < 0.01 || *speed > 1000.0)
    throw ConfigError("--speed " + text + ": 0.01 to 1000, or max, is expected");
  return *speed;
}

void set_range(const ReplayArguments& arguments, const RecordedLog& log, replay::PlayerOptions& player) {
  const Utime first = log.ticks().front();
  const Utime last = log.ticks().back();
  const std::string there = "; the log goes from " + std::to_string(to_seconds(first)) + " s to " +
                            std::to_string(to_seconds(last)) + " s of message time";
  if (arguments.from_s >= 0.0) player.from = to_utime(arguments.from_s);
  if (arguments.until_s >= 0.0) player.until = to_utime(arguments.until_s);
  if (player.from > last) throw ConfigError("--from: after the end" + there);
  if (player.until != kNever && player.until < std::max(first, player.from))
    throw ConfigError("--until: before the beginning" + there);
}

// A restarted service has another state, so it is compared only until the last message of its first process.
void end_at_restarts(const std::vector<std::string>& live, const RecordedLog& log, replay::PlayerOptions& player) {
  for (const std::string& name : live) {
    const auto left = log.left().find(name);
    const auto boots = replay::boots_of(log, name);
    if (left == log.left().end() || boots.empty()) continue;
    player.ended[name] = {boots.begin()->first, boots.begin()->second, left->second};
    std::printf("%s ended in the log: checked until %.2f s\n", name.c_str(), to_seconds(boots.begin()->second));
  }
}

// Without its images a log cannot be recomputed.
void require_whole_streams(const std::string& file, const RecordedLog& log) {
  for (const replay::RecordedStream& stream : log.streams()) {
    const std::int64_t published = stream.last_seq - stream.first_seq + 1;
    if (stream.count < published / 2)
      throw ConfigError(file + ": contains " + std::to_string(stream.count) + " of " + std::to_string(published) +
                        " messages of " + stream.channel + " (recorded reduced): it cannot be checked");
  }
}

Plan make_plan(const ReplayArguments& arguments, const RecordedLog& log) {
  const std::string& log_file = log.run().log;
  Plan plan;
  plan.log_file = log_file;
  plan.log_dir = fs::absolute(log_file).parent_path();
  plan.name = fs::path(log_file).filename() == "traverse.lcm" ? fs::path(plan.log_dir).filename().string()
                                                              : fs::path(log_file).stem().string();
  plan.config_from = config_from(arguments, plan.log_dir);
  plan.bus_url =
      arguments.run.bus.empty() ? Config::load(plan.config_from + "/bus.yaml").text("url") : arguments.run.bus;
  plan.live = live_services(arguments, log);
  plan.records = !plan.live.empty() && !arguments.check && !arguments.loop;
  if (plan.records && std::find(plan.live.begin(), plan.live.end(), "recorder") == plan.live.end())
    plan.live.insert(plan.live.begin(), "recorder");
  const auto is_injection = [](const auto& stream) { return stream.channel == channel::kInject; };
  plan.injects = std::any_of(log.streams().begin(), log.streams().end(), is_injection);
  plan.player.live = plan.live;
  plan.player.speed = arguments.check ? 0.0 : speed_of(arguments.speed);
  set_range(arguments, log, plan.player);
  if (!arguments.check) return plan;
  require_whole_streams(log_file, log);
  end_at_restarts(plan.live, log, plan.player);
  return plan;
}

std::vector<ServiceCommand> service_commands(const Plan& plan) {
  std::vector<ServiceCommand> commands;
  for (const std::string& name : plan.live) commands.push_back({name});
  return commands;
}

// Headers contain the boot number: each service starts with that of its first process in the log.
void set_boots(const Plan& plan, const RecordedLog& log, const RunFolder& folder) {
  for (const std::string& name : plan.live) {
    const auto boots = replay::boots_of(log, name);
    if (!boots.empty()) std::ofstream(folder.dir + "/boots/" + name) << boots.begin()->first - 1 << "\n";
  }
}

// A progress line on a terminal, else nothing.
class Display {
 public:
  Display(Utime last, bool can_go_back)
      : last_(last), can_go_back_(can_go_back), terminal_(isatty(STDOUT_FILENO) == 1) {}
  void show(Utime now, const replay::Pacer& pacer) {
    if (!terminal_ || Clock::now() - shown_ < std::chrono::milliseconds(200)) return;
    shown_ = Clock::now();
    char speed[16] = "max";
    if (pacer.speed() > 0.0) std::snprintf(speed, sizeof speed, "%gx", pacer.speed());
    std::printf("\r\033[K%8.1f / %.1f s  %s  %s   space: pause, %s: 10 s, up/down: speed, q: end", to_seconds(now),
                to_seconds(last_), speed, pacer.paused() ? "paused " : "playing",
                can_go_back_ ? "left/right" : "right");
    std::fflush(stdout);
  }
  ~Display() {
    if (terminal_ && shown_ != Clock::time_point{}) std::printf("\n");
  }

 private:
  using Clock = std::chrono::steady_clock;
  Utime last_;
  bool can_go_back_;
  bool terminal_;
  Clock::time_point shown_{};
};

// Ends the replay if a service has failed.
class Watch {
 public:
  explicit Watch(std::string dir) : dir_(std::move(dir)) {}
  bool fine() {
    const auto now = std::chrono::steady_clock::now();
    if (dir_.empty() || now - looked_ < std::chrono::milliseconds(200)) return fine_;
    looked_ = now;
    fine_ = failed_services(dir_).empty();
    return fine_;
  }

 private:
  std::string dir_;
  std::chrono::steady_clock::time_point looked_{};
  bool fine_ = true;
};

replay::PlayResult play_once(const Plan& plan, RecordedLog& log, const std::string& bus_url, Watch& watch,
                             const replay::Keyboard& keyboard, replay::Comparison* comparison) {
  lcm::LCM bus(bus_url);
  lcm::LCM reports(reports_url(bus_url));
  if (!bus.good() || !reports.good()) throw ConfigError("bus: cannot join " + bus_url);
  Display display(log.ticks().back(), plan.live.empty());
  replay::PlayerHooks hooks;
  hooks.running = [&] { return keep_running() && watch.fine(); };
  hooks.key = [&] { return keyboard.take(); };
  hooks.show = [&](Utime now, const replay::Pacer& pacer) { display.show(now, pacer); };
  replay::Player player(plan.player, log, bus, reports, comparison);
  return player.play(hooks);
}

// For ./rover report: metadata of the recorded run and of the replay.
void write_run_json(const Plan& plan, const RunArguments& arguments, const RunFolder& folder,
                    const replay::PlayResult& played) {
  std::ifstream in(plan.log_dir + "/run.json");
  nlohmann::json facts = nlohmann::json::parse(in, nullptr, false);
  if (!facts.is_object()) facts = {{"scenario", plan.name}};
  facts["commit"] = commit_of(arguments.source_dir);
  facts["outcome"] = "replayed";
  facts["replay_of"] = fs::absolute(plan.log_file).string();
  facts["live"] = plan.live;
  facts["simulated_s"] = played.sim_s();
  facts["wall_s"] = played.wall_s;
  write_json(folder.dir + "/run.json", facts);
}

int print_verdict(const Plan& plan, replay::Comparison& comparison, const replay::PlayResult& played) {
  const auto verdicts = comparison.finish(played.last);
  std::printf("%s", replay::comparison_table(verdicts, replay::field_difference).c_str());
  std::int64_t identical = 0;
  for (const auto& verdict : verdicts) identical += verdict.identical;
  const auto first = replay::first_of(verdicts);
  if (first)
    std::printf("first difference: %s\n", replay::difference_text(*first, replay::field_difference).c_str());
  else
    std::printf("all %lld messages of %zu services byte-identical\n", static_cast<long long>(identical),
                plan.live.size());
  std::printf("%.1f s of message time in %.1f s: %.2f times real time\n", played.sim_s(), played.wall_s,
              played.sim_s() / std::max(1e-9, played.wall_s));
  if (played.quit) std::printf("interrupted: the rest was not checked\n");
  if (!first && identical == 0) std::printf("nothing was compared\n");
  return first || played.quit || identical == 0 ? 1 : 0;
}

// Plays the log once with live services. Returns the exit status; `quit`: by the user.
int play_live(const ReplayArguments& arguments, const Plan& plan, RecordedLog& log, const replay::Keyboard& keyboard,
              bool& quit) {
  const RunFolder folder = make_replay_folder(arguments.run, plan.name, plan.config_from, plan.log_dir);
  write_json(folder.dir + "/launch.json", {{"bus", folder.bus_url}, {"allow_injection", plan.injects}});
  write_s6_tree(folder.dir, service_commands(plan), plan.injects);
  set_boots(plan, log, folder);
  replay::Comparison comparison;
  replay::PlayResult played;
  Watch watch(folder.dir);
  std::string gone;
  {
    S6Session session(folder, arguments.run.bin_dir);
    try {
      played = play_once(plan, log, folder.bus_url, watch, keyboard, arguments.check ? &comparison : nullptr);
    } catch (const replay::ServiceGone& error) {
      gone = error.what();
    }
    session.stop();
  }
  quit = played.quit;
  // Read again: the log of a service is complete when its logger has ended.
  if (const auto all = failed_services(folder.dir); !all.empty()) {
    remove_run_folder(folder);
    throw ConfigError(in_users_files(all.front().line(), folder, plan.config_from));
  }
  if (!gone.empty()) {
    std::fprintf(stderr, "replay: %s; see %s/service_logs\n", gone.c_str(), folder.dir.c_str());
    return 1;
  }
  int status = 0;
  if (arguments.check) status = print_verdict(plan, comparison, played);
  if (plan.records) write_run_json(plan, arguments.run, folder, played);
  if (plan.records)
    std::printf("recorded: %s\n", folder.dir.c_str());
  else if (status == 0 && (arguments.loop || arguments.run.out.empty()))
    remove_run_folder(folder);
  return status;
}

int play_log_alone(const Plan& plan, RecordedLog& log, const replay::Keyboard& keyboard, bool& quit) {
  Watch no_services("");
  quit = play_once(plan, log, plan.bus_url, no_services, keyboard, nullptr).quit;
  return 0;
}

}  // namespace

int replay_log(const ReplayArguments& arguments) {
  RecordedLog log(arguments.log, arguments.log_run);
  print_remarks(log.run());
  if (log.skipped_messages() > 0)
    std::fprintf(stderr,
                 "%s: %lld messages are not played: after the last TICK, or on channels with too long names for LCM\n",
                 log.run().log.c_str(), static_cast<long long>(log.skipped_messages()));
  const Plan plan = make_plan(arguments, log);
  if (arguments.check && log.by_the_clock())
    std::fprintf(stderr,
                 "%s: this run was paced by the clock; in lockstep its services may publish different messages\n",
                 plan.log_file.c_str());
  require_programs(plan.live, arguments.run.bin_dir);
  const BusLock lock(plan.bus_url);
  require_usable_bus(plan.bus_url, lock);
  catch_interrupts();
  const replay::Keyboard keyboard;
  bool quit = false;
  int status = 0;
  do {
    status =
        plan.live.empty() ? play_log_alone(plan, log, keyboard, quit) : play_live(arguments, plan, log, keyboard, quit);
  } while (arguments.loop && !quit && status == 0);
  return status;
}

}  // namespace rover
