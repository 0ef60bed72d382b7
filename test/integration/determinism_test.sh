#!/usr/bin/env bash
# The same scenario and seed give the same run, on an idle and on a loaded machine.
. "$(dirname "$0")/lib.sh"

drive "$WORK/alone" config/scenarios/flat.yaml --seed 5 || true
yes >/dev/null &
load=$!
drive "$WORK/loaded" config/scenarios/flat.yaml --seed 5 || true
kill $load

for run in alone loaded; do
  [ "$(metric "$WORK/$run" outcome)" = goal_reached ] || fail "$run: outcome $(metric "$WORK/$run" outcome)"
  [ "$(metric "$WORK/$run" deterministic)" = true ] || fail "$run: the run calls itself not deterministic"
done
for key in final_truth_pose replans hazard_stops driven_length_m duration_s bus.messages; do
  a=$(metric "$WORK/alone" "$key" | tr -d '\n ')
  b=$(metric "$WORK/loaded" "$key" | tr -d '\n ')
  [ "$a" = "$b" ] || fail "$key differs: $a and $b"
done
echo "two runs, one result"
