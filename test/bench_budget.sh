#!/usr/bin/env bash
# What the services compute, and what the bus carries: the second seed traverse at the Efficient level with the services of
# the Full level on demand, the same at the Full level, and the default scenario at the Full level in real time with a core
# loaded. Then each saving: the first drive without it; and both levels on slower computers. Writes test/results/budget.md.
# Called by ./rover bench budget [--before FOLDER]: a built checkout of an older commit, driven too.
set -euo pipefail
USERS=$PWD
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
shift
before=
while [ $# -gt 0 ]; do
  case $1 in
    --before)
      [ $# -gt 1 ] || { echo "bench budget: --before needs a value" >&2; exit 2; }
      before=$(cd "$USERS" && realpath -m "$2")
      [ -x "$before/build/bin/rover_launcher" ] || { echo "bench budget: --before: $2 is not a built checkout" >&2; exit 2; }
      shift
      ;;
    *) echo "bench budget: '$1' is not an option; known options: --before FOLDER" >&2 && exit 2 ;;
  esac
  shift
done
OUT=test/results/budget.md
LOGS=logs/bench/budget
mkdir -p test/results "$LOGS"

# drive NAME SCENARIO ARGS...
drive() {
  rm -rf "${LOGS:?}/$1"
  "$BUILD/bin/rover_launcher" run "config/scenarios/$2.yaml" --headless "${@:3}" --out "$LOGS/$1"
}

drive efficient seed_traverse_2 --seed 1 --level auto
always_on=(seed_traverse_2 --seed 1 --level auto --set supervisor.level.linger_s=1e6)
drive efficient-filtered "${always_on[@]}"
g++ -shared -fPIC -o "$LOGS/unfiltered_bus.so" test/unfiltered_bus.cpp
LD_PRELOAD=$PWD/$LOGS/unfiltered_bus.so drive efficient-unfiltered "${always_on[@]}"
if [ -n "$before" ]; then
  (cd "$before" && rm -rf "$OLDPWD/$LOGS/efficient-before" &&
    build/bin/rover_launcher run config/scenarios/seed_traverse_2.yaml --headless --seed 1 --level auto \
      --out "$OLDPWD/$LOGS/efficient-before")
fi
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
  echo "Command: \`./rover bench budget${before:+ --before FOLDER}\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  jq -rn --slurpfile e "$LOGS/efficient/metrics.json" --slurpfile f "$LOGS/full/metrics.json" \
    --slurpfile t "$LOGS/realtime/metrics.json" -f test/bench_budget.jq
  echo
  echo "## Savings"
  echo
  echo "The first drive, its part at the Efficient level, each row with one saving more. Without simulator and recorder."
  echo
  echo "| | CPU s per driven metre |"
  echo "|---|---|"
  cost() {  # NAME TEXT
    jq -r --arg text "$2" '"| \($text) | \(([.services | to_entries[] |
      select(.key != "recorder" and .key != "rover_simulator").value.cpu_s_per_m_efficient] | add * 1000 | round) / 1000) |"' \
      "$LOGS/$1/metrics.json"
  }
  [ -z "$before" ] || cost efficient-before "commit $(git -C "$before" describe --always --dirty --abbrev=12)"
  cost efficient-unfiltered "this commit, every service takes every datagram and runs always"
  cost efficient-filtered "datagrams that a service does not take are dropped in the kernel"
  cost efficient "services of the Full level on demand"
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
