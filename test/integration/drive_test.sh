#!/usr/bin/env bash
# ./rover drive with the example driver reaches its goal and reports without ground truth; missing inputs are reported in one line.
. "$(dirname "$0")/lib.sh"
cd "$SOURCE"

# One line, exit status 2, no folder left.
refused() {  # NAME PATTERN ARGS...
  local status=0
  timeout 120 "$BUILD/bin/rover_launcher" drive --headless --out "$WORK/out" --bus "$BUS" "${@:3}" \
    >"$WORK/out.txt" 2>"$WORK/said" || status=$?
  [ $status = 2 ] || fail "$1: exit status $status, said: $(cat "$WORK/said")"
  [ "$(wc -l <"$WORK/said")" = 1 ] || fail "$1: not one line: $(cat "$WORK/said")"
  grep -qE "$2" "$WORK/said" || fail "$1: said: $(cat "$WORK/said")"
  [ ! -e "$WORK/out" ] || fail "$1: leaves a run folder"
}
GROUND=examples/driver/ground.yaml
refused "no ground.yaml" "config/ground.yaml: no such file. .*--ground"
refused "no configuration" "$WORK/none: no such folder" --config "$WORK/none"
refused "no map" "map .*none.tif" --ground $GROUND --map "$WORK/none.tif"
sed 's/y_m: 0.0/y_cm: 0.0/' $GROUND >"$WORK/ground.yaml"
refused "a wrong key" "$WORK/ground.yaml:[0-9]+: start.y_m" --ground "$WORK/ground.yaml"
refused "no driver" "no TICK on .* within 2 s. Start the vehicle's driver" --ground $GROUND --timeout 2

# At a third of real time, so that a loaded machine keeps up.
"$BUILD/bin/example_driver" --bus "$BUS" --pace 0.33 >"$WORK/driver.txt" &
driver=$!
"$BUILD/bin/rover_launcher" drive --headless --until-goal --ground $GROUND --out "$WORK/run" --bus "$BUS" \
  >"$WORK/drive.txt" 2>&1 || fail "the drive ended with $?: $(tail -n 5 "$WORK/drive.txt" "$WORK/run/service_logs/report.log")"
kill -0 $driver || fail "the driver died"
[ "$(metric "$WORK/run" outcome)" = goal_reached ] || fail "outcome: $(metric "$WORK/run" outcome)"
[ "$(metric "$WORK/run" truth)" = false ] || fail "the report contains ground truth"
jq -e '.driven_length_m > 5 and .driven_length_m < 8 and .collisions == null' "$WORK/run/metrics.json" >/dev/null ||
  fail "driven: $(metric "$WORK/run" driven_length_m)"
grep -q "no ground truth" "$WORK/drive.txt" || fail "said: $(tail -3 "$WORK/drive.txt")"
grep -q "no ground truth" "$WORK/run/report.html" || fail "the report does not say that there is no truth"

# The driver continues after the stack has ended. Ctrl-C ends the next drive cleanly.
(exec "$BUILD/bin/rover_launcher" drive --headless --ground $GROUND --out "$WORK/second" --bus "$BUS") >"$WORK/second.txt" 2>&1 &
second=$!
until grep -q DRIVING "$WORK/second.txt"; do
  kill -0 $second 2>/dev/null || fail "the second drive ended: $(tail -5 "$WORK/second.txt")"
  sleep 0.2
done
kill -INT $second
status=0
wait $second || status=$?
[ $status = 1 ] || fail "after Ctrl-C: exit status $status"
[ -s "$WORK/second/report.html" ] || fail "no report after Ctrl-C"
! pgrep -f "run-dir $WORK" >/dev/null || fail "a service is still running"
kill $driver
wait $driver || true
echo "the rover drives with a driver"
