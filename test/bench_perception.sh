#!/usr/bin/env bash
# The geometric tier of perception beside the rendered one. Writes test/results/perception.md and its pictures: speed on
# one core; errors of disparities at the same poses; drives of both tiers on the same seeds, paired. The drives take
# hours: they are two campaigns, which --resume continues. Called by ./rover bench perception: BUILD [--resume] [--jobs N].
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
. test/bench_lib.sh
BUILD=$1
shift
OUT=test/results/perception
LOGS=logs/bench/perception
mkdir -p test/results "$LOGS"

campaign() {  # TIER ARGS...
  local tier=$1
  shift
  sed "s#rendered#$tier#; s#\.\./scenarios#$PWD/config/scenarios#" config/campaigns/tiers.yaml >"$LOGS/$tier.yaml"
  begin_campaign "$LOGS/$tier" "$@"
  "$BUILD/bin/rover_campaign" "$LOGS/$tier.yaml" --out "$LOGS/$tier" "$@"
}
fast() {  # NAME SCENARIO LEVEL: a drive of the geometric tier on one core
  rm -rf "${LOGS:?}/$1"
  taskset -c 0 "$BUILD/bin/rover_launcher" run "config/scenarios/$2.yaml" --seed 41 --level "$3" --perception geometric \
    --record reduced --headless --out "$LOGS/$1" >/dev/null || true
}
speed_row() {  # NAME SCENARIO LEVEL LIMIT
  jq -r --arg s "$2" --arg l "$3" --arg limit "$4" '"| `\($s)`, \($l) | \($limit) | \(.simulated_s / .wall_s * 10 | round / 10) |"' \
    "$LOGS/$1/simulation.json"
}
services_rows() {  # NAME
  jq -r '.simulated_s as $t | .wall_s as $wall | .seconds_of_service
    | (to_entries + [{key: "simulator and bus", value: ($wall - ([.[]] | add))}]) | sort_by(-.value)[]
    | select(.value > 0.02 * $wall) | "| \(.key) | \(.value / $t * 1e3 | round / 1e3) | \(100 * .value / $wall | round) % |"' \
    "$LOGS/$1/simulation.json"
}

campaign geometric "$@"
campaign rendered "$@"
"$BUILD/bin/rover_campaign" compare "$LOGS/rendered" "$LOGS/geometric" --out "$LOGS/compare.md"
fast efficient seed_traverse_2 efficient
fast full full_hard full
{
  echo "# Geometric perception beside rendered"
  echo
  echo "Command: \`./rover bench perception\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  echo "## Speed on one core"
  echo
  echo "| drive, seed 41 | required | times real time |"
  echo "|---|---|---|"
  speed_row efficient seed_traverse_2 Efficient 20
  speed_row full full_hard Full 10
  echo
  echo "What bounds it, in wall time per simulated second:"
  for level in efficient full; do
    echo
    echo "| $level | s per s | part |"
    echo "|---|---|---|"
    services_rows $level
  done
  for camera in loccam navcam; do
    echo
    echo "## Disparity of the $camera"
    echo
    echo "At the same poses on \`full_hard\`, seeds 21 to 23 (fitted on 11 to 13), rendered / geometric; errors against rays."
    echo
    "$BUILD/bench/perception_study" --camera $camera --first-seed 21 --picture "${OUT}_$camera.png"
    echo
    echo "![histograms of disparity errors by depth, rendered and geometric](perception_$camera.png)"
  done
  echo
  echo "## Drives"
  echo
  echo "A: rendered; B: geometric; \`seed_traverse_2\` (Efficient) and \`full_hard\` (Full), seeds 41 to 60."
  echo
  sed '/^# /d' "$LOGS/compare.md"
} >$OUT.md.new
mv $OUT.md.new $OUT.md
cat $OUT.md
