#!/usr/bin/env bash
# ./rover status of a run: every service alive, a killed one restarted; one line if no run exists.
. "$(dirname "$0")/lib.sh"

status() { "$BUILD/bin/rover_launcher" status "$@"; }
# holds FILTER: applies the jq filter to the current status of the run.
holds() { status --json --run "$WORK/run" >"$WORK/status.json" 2>/dev/null && jq -e "$1" "$WORK/status.json" >/dev/null; }
# becomes WHAT FILTER: waits until the filter is true or the run ends.
becomes() {
  until holds "$2"; do
    kill -0 $run 2>/dev/null || fail "$1: not before the end of the run; last: $(cat "$WORK/status.json" 2>/dev/null)"
    sleep 0.1
  done
}
# refused NAME STATUS PATTERN ARGS...
refused() {
  local name=$1 expected=$2 pattern=$3 code=0
  shift 3
  status "$@" >/dev/null 2>"$WORK/said" || code=$?
  [ $code = "$expected" ] || fail "$name: exit status $code, said: $(cat "$WORK/said")"
  [ "$(wc -l <"$WORK/said")" = 1 ] || fail "$name: not one line: $(cat "$WORK/said")"
  grep -q "$pattern" "$WORK/said" || fail "$name: said: $(cat "$WORK/said")"
}

mkdir "$WORK/empty" "$WORK/idle"
cd "$WORK/empty"
refused "no run" 1 "no rover is running"
refused "a silent bus" 1 "no messages received" --bus "$BUS"
refused "a run that is over" 1 "$WORK/idle: no services are running" --run "$WORK/idle"
refused "no folder" 2 "$WORK/none: no such run folder" --run "$WORK/none"

# A drive longer than this test.
(cd "$SOURCE" && exec "$BUILD/bin/rover_launcher" run config/scenarios/seed_traverse_1.yaml --seed 5 --out "$WORK/run" \
  --bus "$BUS") >/dev/null &
run=$!
until [ -e "$WORK/run/services" ]; do
  kill -0 $run 2>/dev/null || fail "the run did not begin"
  sleep 0.1
done

becomes "all services alive with heartbeats" '.state != null and .level == "EFFICIENT" and (.services | length >= 11)
  and .services.rover_simulator.alive
  and all(.services[]; .alive and .pid > 0 and .age_s != null and .restarts == 0 and .rss_mb > 1)
  and all(.services[]; .cpu_percent != null)'
# Rates are per message time and do not depend on the speed of the machine.
becomes "rates in message time" '(.channels.POSE.hz > 45 and .channels.POSE.hz < 55)
  and (.channels.DISPARITY.hz > 2 and .channels.DISPARITY.hz < 3) and .channels.TICK.gaps == 0'
becomes "driving" '.state == "DRIVING" and .permit.granted and .faults == []'

pid=$(jq .services.hazard_detector.pid "$WORK/status.json")
s6-svc -k "$WORK/run/services/hazard_detector"
becomes "killed and started again" ".services.hazard_detector | .restarts == 1 and .alive and .pid != $pid"
becomes "heartbeat received again" '.services.hazard_detector | .age_s != null and .condition == "OK"'
holds '[.services[].restarts] | add == 1' || fail "others were restarted too: $(cat "$WORK/status.json")"

status --run "$WORK/run" >"$WORK/screen"
grep -q '^hazard_detector .* OK ' "$WORK/screen" || fail "the screen shows no hazard_detector: $(cat "$WORK/screen")"
[ "$(wc -L <"$WORK/screen")" -le 100 ] || fail "the screen is too wide"
[ "$(wc -l <"$WORK/screen")" -le 50 ] || fail "the screen has too many lines"
! grep -q $'\033' "$WORK/screen" || fail "colours in a file"

status --bus "$BUS" --json >"$WORK/bus.json"
jq -e '.run == null and .services.stereo.alive and .services.stereo.restarts == null' "$WORK/bus.json" >/dev/null ||
  fail "without a run: $(cat "$WORK/bus.json")"

touch "$WORK/watched"
(exec "$BUILD/bin/rover_launcher" status --watch --run "$WORK/run") >"$WORK/watched" &
watch=$!
until [ "$(grep -c '^SERVICE ' "$WORK/watched")" -ge 2 ]; do
  kill -0 $watch 2>/dev/null || fail "--watch ended"
  sleep 0.1
done
kill -INT $watch
wait $watch || fail "--watch: exit status $? after an interrupt"
kill -0 $run 2>/dev/null || fail "--watch ended with the run, not by the interrupt"

kill -TERM $run
wait $run || true
refused "the run after its end" 1 "no services are running" --run "$WORK/run"
echo "status shows the run"
