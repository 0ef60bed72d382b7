#!/usr/bin/env bash
# The same scenario and seed give the same run, on an idle and on a loaded machine.
. "$(dirname "$0")/lib.sh"

default_for 70 "$WORK/short.yaml"
drive "$WORK/alone" "$WORK/short.yaml" || true
yes >/dev/null &
load=$!
drive "$WORK/loaded" "$WORK/short.yaml" || true
kill $load

for run in alone loaded; do
  [ "$(metric "$WORK/$run" outcome)" = timeout ] || fail "$run: outcome $(metric "$WORK/$run" outcome)"
  [ "$(metric "$WORK/$run" deterministic)" = true ] || fail "$run: the run is marked as not deterministic"
done
[ "$(metric "$WORK/alone" replans)" -gt 0 ] || fail "no obstacle on the path"
for key in final_truth_pose replans hazard_stops driven_length_m duration_s bus.messages; do
  a=$(metric "$WORK/alone" "$key" | tr -d '\n ')
  b=$(metric "$WORK/loaded" "$key" | tr -d '\n ')
  [ "$a" = "$b" ] || fail "$key differs: $a and $b"
done
echo "both runs are identical"
