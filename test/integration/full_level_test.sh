#!/usr/bin/env bash
# A short drive at the Full level: the path raises the level, the NavCam sweeps, maps are made, the goal is reached. In a
# replay every service publishes identical bytes. At the Efficient level the services of the Full level do not run; where
# the level may change, they are stopped until the path needs them.
. "$(dirname "$0")/lib.sh"
cd "$SOURCE"

# The first six metres of full_hard.
sed "s#\.\./terrain#$SOURCE/config/terrain#; /^ \{8\}/d; s/^  x_m: .*/  x_m: [117.0, 117.24, 117.47, 117.67, 117.82]/
     s/^  y_m: .*/  y_m: [105.0, 106.51, 108.02, 109.53, 111.04]/; s/^  level: .*/  level: [1, 1, 1, 1, 1]/; s/^timeout_s:.*/timeout_s: 300/" \
  config/scenarios/full_hard.yaml >"$WORK/short.yaml"
drive "$WORK/run" "$WORK/short.yaml" --headless >"$WORK/said" 2>&1 || fail "does not reach its goal: $(tail -3 "$WORK/said")"
[ "$(metric "$WORK/run" outcome)" = goal_reached ] || fail "outcome $(metric "$WORK/run" outcome)"
[ "$(metric "$WORK/run" 'level_switches[0].to')" = FULL ] || fail "the level did not go up"
[ "$(metric "$WORK/run" 'level_switches[0].reason')" = path_segment ] || fail "not because of the path"
[ "$(metric "$WORK/run" 'time_in_state_s.SWEEPING > 0')" = true ] || fail "no sweep"
[ "$(metric "$WORK/run" deterministic)" = true ] || fail "the run is marked as not deterministic"
for picture in elevation levels; do [ -s "$WORK/run/$picture.png" ] || fail "no $picture.png"; done

"$BUILD/bin/rover_launcher" replay "$WORK/run" --check --bus "$BUS" --out "$WORK/check" >"$WORK/out" ||
  fail "differs from its own log: $(cat "$WORK/out")"
for channel in PTU_COMMAND CLOUD ELEVATION SLAM_POSE TRAVERSABILITY PATH; do
  grep -qE "^$channel .* [1-9][0-9]* identical$" "$WORK/out" || fail "$channel was not compared: $(cat "$WORK/out")"
done

echo "-- on demand"
six_metres "$WORK/flat.yaml"
sed -i "s/^  y_m: .*/&\n  level: [0, 0, 1, 1]/" "$WORK/flat.yaml"
drive "$WORK/demand" "$WORK/flat.yaml" --headless --level auto --set supervisor.level.linger_s=5 >"$WORK/said" 2>&1 ||
  fail "on demand: $(tail -3 "$WORK/said")"
for metric_is in outcome=goal_reached deterministic=true 'level_switches[0].to=FULL' services.slam.restarts=0 bus.lost=0; do
  [ "$(metric "$WORK/demand" "${metric_is%=*}")" = "${metric_is#*=}" ] || fail "on demand: not $metric_is"
done
[ "$(cat "$WORK/demand/boots/slam")" = 2 ] || fail "slam was not stopped and started: $(cat "$WORK/demand/boots/slam")"
[ "$(cat "$WORK/demand/boots/stereo")" = 1 ] || fail "stereo was restarted"
"$BUILD/bin/rover_launcher" replay "$WORK/demand" --check --bus "$BUS" --out "$WORK/check2" >"$WORK/out" ||
  fail "on demand: differs from its own log: $(cat "$WORK/out")"
grep -q "^slam ended in the log: checked until" "$WORK/out" || fail "not said: $(cat "$WORK/out")"

default_for 21 "$WORK/default.yaml"
drive "$WORK/efficient" "$WORK/default.yaml" --headless >/dev/null 2>&1 || true
[ -e "$WORK/efficient/services/stereo" ] || fail "no services"
[ ! -e "$WORK/efficient/services/slam" ] || fail "slam runs at the Efficient level"
echo "the Full level reaches the goal"
