#include "tools/report/time_account.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/time.hpp"

namespace rover::report {
namespace {

constexpr double kRollingMps = 0.01;        // mean of the wheels; encoders at rest show at most 0.002
constexpr double kSteeringOverS = 0.1;      // interval for steering rates: an encoder resolves 0.1 deg
const double kSteeringRadps = to_rad(1.0);  // the motors turn at 11.5 deg/s
constexpr double kCurvePerM = 0.1;          // radius of 10 m
constexpr double kMaxWheelStateAgeS = 0.2;  // older: unknown
constexpr double kCountedStepM = 0.02;

struct Texts {
  const char* key;
  const char* title;
};
constexpr std::array<Texts, kTimeCauses> kTexts = {{{"straight", "Straight"},
                                                    {"curve", "Curve"},
                                                    {"point_turn", "Point turn"},
                                                    {"steering", "Steering at rest"},
                                                    {"reverse", "Reverse"},
                                                    {"waiting_for_plan", "Waiting for a plan"},
                                                    {"hazard_stop", "Hazard stop"},
                                                    {"sweep", "Sweep"},
                                                    {"blind", "Blind"},
                                                    {"fault", "Fault"},
                                                    {"other", "Other"}}};

const WheelSample* wheels_at(const RunRecord& run, double t_s) {
  const WheelSample* sample = newest(run.wheels, t_s);
  return sample == nullptr || t_s - sample->t_s > kMaxWheelStateAgeS ? nullptr : sample;
}

// Mean rolling speeds of the left and of the right wheels.
struct Rolling {
  double left_mps = 0.0;
  double right_mps = 0.0;
  bool moves() const { return 0.5 * (std::abs(left_mps) + std::abs(right_mps)) > kRollingMps; }
  bool turns_on_the_spot() const { return left_mps * right_mps < 0.0; }
};

Rolling rolling(const WheelSample& sample, const VehicleWheels& wheels) {
  Rolling out;
  for (size_t i = 0; i < sample.rate_radps.size(); i += 2) {
    out.left_mps += wheels.radius_m * sample.rate_radps[i] / 3.0;
    out.right_mps += wheels.radius_m * sample.rate_radps[i + 1] / 3.0;
  }
  return out;
}

bool steers(const RunRecord& run, const WheelSample& now) {
  const WheelSample* before = wheels_at(run, now.t_s - kSteeringOverS);
  if (before == nullptr) return false;
  double largest = 0.0;
  for (size_t i = 0; i < now.steer_rad.size(); ++i)
    largest = std::max(largest, std::abs(now.steer_rad[i] - before->steer_rad[i]));
  return largest > kSteeringRadps * kSteeringOverS;
}

// Of the steered front wheels about a centre on the axis of the middle ones.
double curvature_per_m(const WheelSample& sample, const VehicleWheels& wheels) {
  return 0.5 * (std::tan(sample.steer_rad[0]) + std::tan(sample.steer_rad[1])) / wheels.p_body[0].x();
}

TimeCause driving_cause(const RunRecord& run, const VehicleWheels& wheels, double t_s) {
  const WheelSample* sample = wheels_at(run, t_s);
  if (sample == nullptr) return TimeCause::kOther;
  const Rolling speed = rolling(*sample, wheels);
  if (speed.moves()) {
    if (speed.turns_on_the_spot()) return TimeCause::kPointTurn;
    if (speed.left_mps < 0.0) return TimeCause::kReverse;
    return std::abs(curvature_per_m(*sample, wheels)) < kCurvePerM ? TimeCause::kStraight : TimeCause::kCurve;
  }
  if (steers(run, *sample)) return TimeCause::kSteering;
  const ControlSample* control = newest(run.control, t_s);
  const bool has_no_path =
      control != nullptr && (control->following == Following::kIdle || control->following == Following::kPathEnd);
  return has_no_path ? TimeCause::kWaitingForPlan : TimeCause::kOther;
}

bool stopped_by_hazard(State state) {
  return state == State::kHazardStop || state == State::kRepairing;
}

// A new path comes before the rover drives again, or it never drives again.
bool waits_for_path(const RunRecord& run, double t_s) {
  const auto ahead = [](double t, const auto& item) { return t < item.t_s; };
  const auto path = std::upper_bound(run.local_paths.begin(), run.local_paths.end(), t_s, ahead);
  const auto drives = std::find_if(std::upper_bound(run.states.begin(), run.states.end(), t_s, ahead), run.states.end(),
                                   [](const StateChange& change) { return change.state == State::kDriving; });
  if (drives == run.states.end()) return true;
  return path != run.local_paths.end() && path->t_s <= drives->t_s;
}

TimeCause stop_cause(const RunRecord& run, const VehicleWheels& wheels, double t_s) {
  const PlannerSample* planner = newest(run.planner, t_s);
  if (planner != nullptr && planner->blocked_by_unseen) return TimeCause::kBlind;
  const WheelSample* sample = wheels_at(run, t_s);
  const bool braking = sample != nullptr && rolling(*sample, wheels).moves();
  return !braking && waits_for_path(run, t_s) ? TimeCause::kWaitingForPlan : TimeCause::kHazardStop;
}

// The rows of config/fdir.yaml by which the rover stops because it sees nothing.
bool blinds(const std::string& row) {
  return row == "hazards_age" || row == "hazards_blind" || row == "stereo_coverage";
}

}  // namespace

const char* key_of(TimeCause cause) {
  return kTexts[static_cast<size_t>(cause)].key;
}
const char* title_of(TimeCause cause) {
  return kTexts[static_cast<size_t>(cause)].title;
}

TimeCause cause_at(const RunRecord& run, const VehicleWheels& wheels, double t_s) {
  const StateChange* change = newest(run.states, t_s);
  if (change == nullptr) return TimeCause::kOther;
  if (stopped_by_hazard(change->state)) return stop_cause(run, wheels, t_s);
  switch (change->state) {
    case State::kDriving:
      return driving_cause(run, wheels, t_s);
    case State::kSweeping:
      return TimeCause::kSweep;
    case State::kFaultStop:
      return blinds(change->cause) ? TimeCause::kBlind : TimeCause::kFault;
    case State::kSafe:
      return TimeCause::kFault;
    default:
      return TimeCause::kOther;
  }
}

TimeAccount account_time(const RunRecord& run, const VehicleWheels& wheels, const Window& window) {
  std::array<Utime, kTimeCauses> spent{};
  const Utime end = to_utime(window.end_s);
  for (Utime t = to_utime(window.begin_s); t < end; t += kTickUs)
    spent[static_cast<size_t>(cause_at(run, wheels, to_seconds(t)))] += std::min(kTickUs, end - t);
  TimeAccount account;
  std::transform(spent.begin(), spent.end(), account.seconds.begin(),
                 [](Utime us) { return static_cast<double>(us) / 1e6; });  // the nearest decimal, unlike us * 1e-6
  return account;
}

double reverse_distance_m(const RunRecord& run, const Window& window) {
  if (run.truth.empty()) return kNaN;
  double distance = 0.0;
  Eigen::Vector2d counted = Eigen::Vector2d::Constant(kNaN);
  for (const TruthSample& sample : run.truth) {
    if (!window.contains(sample.t_s)) continue;
    const Eigen::Vector2d p = sample.T_map_body.translation().head<2>();
    if (counted.hasNaN()) counted = p;
    const Eigen::Vector2d step = p - counted;
    if (step.norm() < kCountedStepM) continue;
    const double yaw = planar(sample.T_map_body).yaw_rad;
    distance += std::max(0.0, -step.dot(Eigen::Vector2d(std::cos(yaw), std::sin(yaw))));
    counted = p;
  }
  return distance;
}

}  // namespace rover::report
