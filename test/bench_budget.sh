#!/usr/bin/env bash
# What the services compute, and what the bus carries: the second seed traverse at the Efficient level with the services of
# the Full level waiting, the same at the Full level, and the default scenario at the Full level in real time with a core
# loaded. Writes test/results/budget.md.
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
{
  echo "# Computing budget"
  echo
  echo "Command: \`./rover bench budget\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  jq -rn --slurpfile e "$LOGS/efficient/metrics.json" --slurpfile f "$LOGS/full/metrics.json" \
    --slurpfile t "$LOGS/realtime/metrics.json" -f test/bench_budget.jq
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
