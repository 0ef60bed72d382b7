#!/usr/bin/env bash
# Runs with faults from a scenario are deterministic. ./rover inject injects faults into a running system and refuses
# invalid ones in one line.
. "$(dirname "$0")/lib.sh"

# scenario FILE FAULT...: six metres of the flat scenario with the faults.
scenario() {
  local file=$1
  shift
  six_metres "$file"
  [ $# = 0 ] || { echo "faults:" && printf '  - %s\n' "$@"; } >>"$file"
}

# refused PATTERN ARGS...: one line, exit status 2.
refused() {
  local pattern=$1 status=0
  shift
  "$BUILD/bin/rover_launcher" inject "$@" >/dev/null 2>"$WORK/said" || status=$?
  [ $status = 2 ] || fail "inject $*: exit status $status, said: $(cat "$WORK/said")"
  [ "$(wc -l <"$WORK/said")" = 1 ] || fail "inject $*: not one line: $(cat "$WORK/said")"
  grep -q -- "$pattern" "$WORK/said" || fail "inject $*: said: $(cat "$WORK/said")"
}

cd "$WORK"
"$BUILD/bin/rover_launcher" inject --list | grep -q '^wheel_jammed ' || fail "--list does not name wheel_jammed"
refused "no fault given" --run "$WORK"
refused "'explode' is not a fault" explode stereo
refused "'radio' is not a service" kill radio
refused "amount: out of range" drop POSE --amount 1.5
refused "amount is required" tilt_roll
refused "has no duration" kill stereo --for 3
refused "no run is active" kill stereo
refused "$WORK: no run is active there" kill stereo --run "$WORK"

scenario "$WORK/bad.yaml" "{fault: kill, target: stereo, at_s: 1, after_m: 1}"
status=0
"$BUILD/bin/rover_launcher" run "$WORK/bad.yaml" --out "$WORK/out" --bus "$BUS" >/dev/null 2>"$WORK/said" || status=$?
[ $status = 2 ] && grep -q 'bad.yaml:[0-9]*: faults\[0\].after_m: only one trigger is allowed' "$WORK/said" ||
  fail "two triggers: exit status $status, said: $(cat "$WORK/said")"

# A kill during the drive, and random message losses with the seeds of the nodes.
scenario "$WORK/killed.yaml" "{fault: kill, target: stereo, after_m: 2.0}" "{fault: loss, amount: 0.02, at_s: 10, for_s: 5}"
for run in one two; do
  drive "$WORK/$run" "$WORK/killed.yaml" --seed 5 || true
  [ "$(metric "$WORK/$run" outcome)" = goal_reached ] || fail "$run: outcome $(metric "$WORK/$run" outcome)"
  [ "$(metric "$WORK/$run" deterministic)" = true ] || fail "$run: the run is marked as not deterministic"
  grep -q 'stereo killed at' "$WORK/$run/simulation.json" || fail "$run: stereo was not killed"
  [ "$(cat "$WORK/$run/boots/stereo")" = 2 ] || fail "$run: stereo started $(cat "$WORK/$run/boots/stereo") times"
done
for key in final_truth_pose replans hazard_stops driven_length_m duration_s odometry_drift_percent bus.messages; do
  a=$(metric "$WORK/one" "$key" | tr -d '\n ')
  b=$(metric "$WORK/two" "$key" | tr -d '\n ')
  [ "$a" = "$b" ] || fail "$key differs: $a and $b"
done

# ./rover inject on a running system.
scenario "$WORK/plain.yaml"
drive "$WORK/live" "$WORK/plain.yaml" --seed 5 --allow-injection >/dev/null &
launcher=$!
for _ in $(seq 600); do
  grep -qs 'to=DRIVING' "$WORK/live/service_logs/supervisor/current" && break
  sleep 0.1
done
"$BUILD/bin/rover_launcher" inject camera_blind both --for 3 --run "$WORK/live" || fail "camera_blind was not injected"
"$BUILD/bin/rover_launcher" inject kill stereo --run "$WORK/live" || fail "stereo was not killed"
wait $launcher || true
grep -q 'INJECTED fault=camera_blind target=both' "$WORK/live/service_logs/rover_simulator/current" ||
  fail "the simulator did not receive camera_blind"
[ "$(cat "$WORK/live/boots/stereo")" = 2 ] || fail "stereo was not restarted"
[ "$(metric "$WORK/live" deterministic)" = false ] || fail "a run with ./rover inject is marked as deterministic"

! pgrep -f ":$PORT[?]" >/dev/null || fail "a process is still running: $(pgrep -af ":$PORT[?]")"
echo "faults are injected as requested"
