// Example status with a value in every field.
#pragma once

#include "tools/status/snapshot.hpp"

namespace rover::status {

inline ServiceStatus example_service(int pid, double age_s) {
  ServiceStatus service;
  service.process = {pid, true, 0, 12.34, 45.67};
  service.age_s = age_s;
  Heartbeat beat;
  beat.health = Health::kOk;
  beat.pid = pid;
  beat.step_p50_ms = 1.25;
  beat.step_p99_ms = 3.5;
  service.heartbeat = beat;
  return service;
}

inline StateReport example_state() {
  StateReport state;
  state.state = "FAULT_STOP";
  state.level = "EFFICIENT";
  state.cause = "heartbeat.stereo";
  state.quantity = "heartbeat_age_s";
  state.value = 1.02;
  state.threshold = 1.0;
  state.hazard_stops = 1;
  return state;
}

inline Snapshot example_status() {
  Snapshot s;
  s.run_dir = "/somewhere/logs/20251121-160000-default";
  s.bus_url = "udpm://239.255.76.67:7667?ttl=0";
  s.now = 83'420'000;
  s.realtime_factor = 3.41;
  s.tick_silence_s = 0.01;
  s.state = example_state();
  s.state_for_s = 2.5;
  s.permit = PermitReport{false, "FAULT_STOP"};
  s.faults = {{{80'000'000, "heartbeat.stereo", "STALE", "STOP", 3.52, 1.0, 80'920'000, true}, 2.5}, {{}, kNaN}};
  s.faults[1].report.id = "hazards_age";
  s.services["locomotion"] = example_service(101, 0.2);
  s.services["recorder"] = example_service(102, 0.18);
  s.services["recorder"].heartbeat->health = Health::kDegraded;
  s.services["recorder"].heartbeat->text = "disk full: 12 MB left";
  s.services["recorder"].heartbeat->gaps = 3;
  s.services["rover_simulator"].process = {103, true, 0, 60.0, 210.0};
  s.services["rover_simulator"].age_s = 0.01;
  s.services["stereo"] = example_service(0, 3.52);
  s.services["stereo"].process = {0, false, 2, kNaN, kNaN};
  s.services["visual_odometry"].process = {104, true, 1, 0.0, 33.3};
  s.services["visual_odometry"].quiet_s = 4.1;
  s.channels["DISPARITY"] = {2.5, 8.5, 983'000.0, 3.5, 0, 0};
  s.channels["PATH"] = {0.0, 0.0, 0.0, 21.06, 0, 0};
  s.channels["POSE"] = {50.0, 170.5, 110'000.0, 0.0, 0, 0};
  s.channels["SLIP"] = {10.0, 34.1, 4'400.0, 0.02, 2, 1};
  s.channels["TICK"] = {50.0, 170.5, 90'000.0, 0.0, 0, 0};
  return s;
}

}  // namespace rover::status
