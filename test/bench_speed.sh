#!/usr/bin/env bash
# Speed of the whole stack, one run at a time on an idle machine: the default scenario from command to end, the real-time
# factor of a seed traverse, and the same traverse with one core loaded, which must give the same result. Writes
# test/results/speed.md.
# Called by ./rover bench speed.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/speed.md
LOGS=logs/bench/speed
mkdir -p test/results "$LOGS"
seconds() { date +%s.%N; }
since() { echo "$(seconds) $1" | awk '{ printf "%.1f", $1 - $2 }'; }

# drive NAME SCENARIO ARGS...: sets drive_s, and motion_s: from the command to the state DRIVING.
drive() {
  local begin line
  begin=$(seconds)
  motion_s=-
  rm -rf "${LOGS:?}/$1"
  while IFS= read -r line; do
    [ "$motion_s" = - ] && [[ $line == *DRIVING* ]] && motion_s=$(since "$begin")
    printf '%s\n' "$line"
  done < <("$BUILD/bin/rover_launcher" run "config/scenarios/$2.yaml" "${@:3}" --out "$LOGS/$1")
  drive_s=$(since "$begin")
}
figure() { jq -r "$2" "$LOGS/$1/metrics.json"; }

# Metrics that must be identical in both runs.
result() { figure "$1" '[.outcome, .final_truth_pose, .replans, .hazard_stops, .driven_length_m, .duration_s, .deterministic] | tostring'; }

drive default default
default_motion_s=$motion_s default_s=$drive_s
drive seed_traverse_1 seed_traverse_1 --seed 1
drive realtime default --realtime
yes >/dev/null &
load=$!
trap 'kill $load' EXIT
drive loaded seed_traverse_1 --seed 1
same=no
[ "$(result seed_traverse_1)" != "$(result loaded)" ] || same=yes
{
  echo "# Speed"
  echo
  echo "Command: \`./rover bench speed\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  echo "| requirement | measured |"
  echo "|---|---|"
  echo "| first motion within 5 s of the command (\`default\`, built) | $default_motion_s s |"
  echo "| \`default\` at most 120 s, report included | $default_s s, $(figure default .outcome) |"
  echo "| \`seed_traverse_1\` at least 3 times real time | $(figure seed_traverse_1 '.realtime_factor * 100 | round / 100') ($(figure seed_traverse_1 '.sim_s | round') s in $(figure seed_traverse_1 '.wall_s | round') s), $(figure seed_traverse_1 .outcome) |"
  echo "| \`default --realtime\` reaches its goal | $(figure realtime .outcome), $(figure realtime '(.realtime_factor // 0) * 100 | round / 100') times real time |"
  echo "| \`seed_traverse_1\` again with a core loaded: identical final pose, counts and lengths | $same ($(figure loaded '.realtime_factor * 100 | round / 100') times real time) |"
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
