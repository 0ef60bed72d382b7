#!/usr/bin/env bash
# The same scenario and seed give the same run, on an idle and on a loaded machine.
. "$(dirname "$0")/lib.sh"

drive "$WORK/a" config/scenarios/default.yaml --seed 5 >/dev/null || true
(while :; do :; done) &
load=$!
drive "$WORK/b" config/scenarios/default.yaml --seed 5 >/dev/null || true
kill $load

for key in outcome deterministic final_truth_pose replans hazard_stops rocks_encountered driven_length_m bus.messages; do
  a=$(metric "$WORK/a" "$key" | tr -d '\n ')
  b=$(metric "$WORK/b" "$key" | tr -d '\n ')
  [ "$a" = "$b" ] || fail "$key differs: $a and $b"
done
[ "$(metric "$WORK/a" deterministic)" = true ] || fail "the run calls itself not deterministic"
[ "$(metric "$WORK/a" outcome)" = goal_reached ] || fail "outcome $(metric "$WORK/a" outcome)"
echo "two runs, one result"
