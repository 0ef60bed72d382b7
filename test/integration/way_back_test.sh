#!/usr/bin/env bash
# A rover that leans too far where it stands for long: it backs out over its own track, and goes on to its goal when the
# ground lets it.
. "$(dirname "$0")/lib.sh"
cd "$WORK"

six_metres "$WORK/leaning.yaml"
echo "faults: [{fault: tilt_roll, target: ground, amount: 21.5, at_m: 3.0, for_s: 30}]" >>"$WORK/leaning.yaml"
drive "$WORK/run" "$WORK/leaning.yaml" --headless >"$WORK/said" 2>&1 || fail "does not reach its goal: $(tail -3 "$WORK/said")"
[ "$(metric "$WORK/run" outcome)" = goal_reached ] || fail "outcome $(metric "$WORK/run" outcome)"
[ "$(metric "$WORK/run" 'fdir | map(select(.id == "roll" and .response == "stop_retreat")) | length')" = 1 ] ||
  fail "the roll was not told once: $(metric "$WORK/run" fdir)"
planner="$WORK/run/service_logs/path_planner/current"
[ "$(grep -c 'kind=RETREAT' "$planner")" = 1 ] || fail "not one way back: $(grep 'PATH id' "$planner")"
[ "$(metric "$WORK/run" 'driven_length_m > 7.5')" = true ] || fail "drove $(metric "$WORK/run" driven_length_m) m: not back"
echo "back out of the slope and on to the goal"
