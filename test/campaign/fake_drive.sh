#!/usr/bin/env bash
# In place of ./rover run in the tests of campaigns: the same arguments, and metrics that depend on the seed alone, but
# for the wall time. $FAKE_DRIVE has files that say what happens: seconds, die-SEED, die-once-SEED, fill, commit.
set -euo pipefail
scenario=$2
while [ $# -gt 1 ]; do
  case $1 in
    --seed) seed=$2 ;;
    --out) out=$2 ;;
  esac
  shift
done
mkdir -p "$out"
echo "$seed $out" >>"$FAKE_DRIVE/starts"
trap 'kill $(jobs -p) 2>/dev/null; exit 143' TERM
sleep "$(cat "$FAKE_DRIVE/seconds")" &
wait
if [ -e "$FAKE_DRIVE/fill" ]; then fallocate -l "$(cat "$FAKE_DRIVE/fill")" "$out/traverse.lcm"; fi
if [ -e "$FAKE_DRIVE/die-$seed" ]; then
  mkdir -p "$out/service_logs/path_planner"
  echo "began" >"$out/service_logs/path_planner/current"
  seq -f 'path_planner: waits for tick %g' 5000
  echo "path_planner: config/path_planner.yaml:3: out of range" >&2
  exit 2
fi
if rm "$FAKE_DRIVE/die-once-$seed" 2>/dev/null; then kill -9 $$; fi
outcome=goal_reached
[ $((seed % 4)) != 0 ] || outcome=no_path
commit=null
if [ -e "$FAKE_DRIVE/commit" ]; then commit=\"$(cat "$FAKE_DRIVE/commit")\"; fi
k=$(sed -n 's/.*rock_area_k: *//p' "$scenario")
cat >"$out/metrics.json" <<JSON
{"outcome": "$outcome", "commit": $commit, "wall_s": $RANDOM.5, "realtime_factor": $RANDOM, "seed": $seed, "path_ratio": 1.$seed, "rock_area": ${k:-0}, "collisions": 0, "seconds": {"curve": $seed}}
JSON
