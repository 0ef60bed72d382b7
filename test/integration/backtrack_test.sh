#!/usr/bin/env bash
# A stationary rover whose tilt stays over the limit backs up along its own track, and continues to its goal when the tilt
# is gone.
. "$(dirname "$0")/lib.sh"
cd "$WORK"

six_metres "$WORK/leaning.yaml"
echo "faults: [{fault: tilt_roll, target: ground, amount: 21.5, after_m: 3.0, for_s: 30}]" >>"$WORK/leaning.yaml"
drive "$WORK/run" "$WORK/leaning.yaml" --headless >"$WORK/said" 2>&1 || fail "does not reach its goal: $(tail -3 "$WORK/said")"
[ "$(metric "$WORK/run" outcome)" = goal_reached ] || fail "outcome $(metric "$WORK/run" outcome)"
[ "$(metric "$WORK/run" 'fdir | map(select(.id == "roll" and .response == "stop_backtrack")) | length')" = 1 ] ||
  fail "the roll fault was not raised exactly once: $(metric "$WORK/run" fdir)"
planner="$WORK/run/service_logs/path_planner/current"
[ "$(grep -c 'kind=BACKTRACK' "$planner")" = 1 ] || fail "not exactly one backtrack: $(grep 'PATH id' "$planner")"
[ "$(metric "$WORK/run" 'driven_length_m > 7.5')" = true ] || fail "drove $(metric "$WORK/run" driven_length_m) m: not back"
echo "the rover backs up and reaches the goal"
