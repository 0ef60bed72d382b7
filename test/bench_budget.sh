#!/usr/bin/env bash
# What the services compute, and what the bus carries: the second seed traverse at the Efficient level with the services of
# the Full level on demand, the same at the Full level, and the default scenario at the Full level in real time with a core
# loaded. Then both levels on slower computers. Writes test/results/budget.md.
# Called by ./rover bench budget.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/budget.md
LOGS=logs/bench/budget
mkdir -p test/results "$LOGS"

# drive NAME SCENARIO ARGS...
drive() {
  rm -rf "${LOGS:?}/$1"
  "$BUILD/bin/rover_launcher" run "config/scenarios/$2.yaml" --headless "${@:3}" --out "$LOGS/$1"
}

drive efficient seed_traverse_2 --seed 1 --level auto
drive full seed_traverse_2 --seed 1 --level full
yes >/dev/null &
load=$!
trap 'kill $load' EXIT
drive realtime default --level full --realtime
kill $load
trap - EXIT
for scale in 3 10 30; do
  for level in efficient full; do
    drive $level-$scale seed_traverse_2 --seed 1 --level $level --cpu-scale $scale || true  # not reaching the goal is a result
  done
done
{
  echo "# Computing budget"
  echo
  echo "Command: \`./rover bench budget\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  jq -rn --slurpfile e "$LOGS/efficient/metrics.json" --slurpfile f "$LOGS/full/metrics.json" \
    --slurpfile t "$LOGS/realtime/metrics.json" -f test/bench_budget.jq
  echo
  echo "## Slower computers"
  echo
  echo "Seed traverse 2, seed 1, with \`--cpu-scale\`: latencies times the scale (exposure to HAZARDS 0.24 s, to PATH 0.44 s at scale"
  echo "1); while a service is busy newer frames wait, and it takes the newest."
  echo
  echo "| scale | level | outcome | driven / planned | progress | hazard stops | collisions | rocks missed | frames of odometry | drift [%] |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
  for scale in 1 3 10 30; do
    for level in efficient full; do
      name=$level-$scale
      jq -r --arg scale $scale --arg level $level 'def r: if . == null then "-" else (. * 100 | round) / 100 end;
        "| \($scale) | \($level) | \(.outcome) | \(.path_ratio | r) | \(.progress | r) | \(.hazard_stops) |" +
        " \(.collisions) | \(.rocks_missed) | \(.vo_frames) | \(.odometry_drift_percent | r) |"' \
        "$LOGS/${name%-1}/metrics.json"
    done
  done
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
