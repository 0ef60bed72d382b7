#!/usr/bin/env bash
# What the path costs, the map or the policy: full_hard (Full) and seed_traverse_2 (Efficient) with maps made from the
# truth, from rays and from images, and with single parameters changed. Each variant is a campaign in logs/bench/cost, so
# --resume continues. Writes the tables of test/results/cost.md. Called by ./rover bench cost: BUILD [--seeds a..b]
# [--variants a,b] [--resume] [--jobs N].
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
. test/bench_lib.sh
BUILD=$1
shift
OUT=test/results/cost.md
LOGS=logs/bench/cost
SEEDS=11..30
FEW_SEEDS=11..16  # of rendered drives, which take ten times as long, and of single parameters
ONLY='[a-z_]*'
COMMAND="./rover bench cost"
arguments=()
while [ $# -gt 0 ]; do
  case $1 in
    --seeds) COMMAND+=" $1 $2" SEEDS=$2 FEW_SEEDS=$2 && shift ;;
    --variants) COMMAND+=" $1 $2" ONLY=${2//,/|} && shift ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
mkdir -p test/results "$LOGS"

# NAME | SCENARIOS | what differs from the variant geometric
VARIANTS='truth | seed_traverse_2 full_hard | perception: truth
geometric | seed_traverse_2 full_hard | perception: geometric
rendered | seed_traverse_2 full_hard | perception: rendered
height_ratio | full_hard | traversability.step.mean_height_ratio: 1.0
grow_height | full_hard | traversability.step.grow_height_m: 0.12
hazard_cost | seed_traverse_2 full_hard | path_planner.ground.hazard_cost: 1.0
clearance | seed_traverse_2 full_hard | path_planner.clearance.min_m: 0.05
switching | seed_traverse_2 full_hard | path_planner.search.switching_cost_s: 1.0
horizon | seed_traverse_2 full_hard | path_planner.search.horizon_m: 9.0
together | seed_traverse_2 full_hard | traversability.step.mean_height_ratio: 1.0, traversability.step.grow_height_m: 0.12, path_planner.ground.hazard_cost: 1.0, path_planner.clearance.min_m: 0.05'
variants() { sed 's/ *| */|/g' <<<"$VARIANTS" | grep -E "^($ONLY)\|"; }
variants >/dev/null || { echo "bench cost: no such variant: ${ONLY//|/,}" >&2; exit 2; }
names=$(variants | cut -d'|' -f1)
if grep -qx 'truth\|rendered' <<<"$names" && ! grep -qx geometric <<<"$names"; then
  echo "bench cost: truth and rendered are compared with geometric; add it to --variants" >&2
  exit 2
fi

level_of() { [ "$1" = full_hard ] && echo full || echo efficient; }
drive() {  # NAME SCENARIOS CHANGES
  local seeds=$SEEDS changes=$3
  case $1 in truth | geometric) ;; *) seeds=$FEW_SEEDS ;; esac
  case $changes in *perception:*) ;; *) changes="perception: geometric, $changes" ;; esac
  {
    echo "seeds: $seeds"
    echo "axes: {$changes}"
    echo "blocks:"
    for scenario in $2; do
      echo "  - {scenario: ../../../config/scenarios/$scenario.yaml, axes: {level: $(level_of "$scenario")}}"
    done
  } >"$LOGS/$1.yaml"
  begin_campaign "$LOGS/$1" "${arguments[@]}"
  "$BUILD/bin/rover_campaign" "$LOGS/$1.yaml" --out "$LOGS/$1" "${arguments[@]}"
}
row() {  # NAME SCENARIO [LAST_SEED TITLE]
  jq -rs --arg name "${4:-$1}" --arg level "$(level_of "$2")" --argjson last_seed "${3:-null}" -f test/bench_cost.jq \
    "$LOGS/$1/rows.jsonl"
}
table() {  # SCENARIO
  echo "| variant | drives | at the goal | ratio: median, worst | regret: median | progress: median | hazard stops, false per drive | closed / true area: HAZARDS, TRAVERSABILITY | straight | curve | steering | point turn | reverse | waiting | stop | other |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
  while IFS='|' read -r name scenarios changes; do
    case " $scenarios " in *" $1 "*) ;; *) continue ;; esac
    row "$name" "$1"
    case $name in truth | geometric) [ "$FEW_SEEDS" = "$SEEDS" ] || row "$name" "$1" "${FEW_SEEDS##*..}" "$name, $FEW_SEEDS" ;; esac
  done < <(variants)
}

commits() { for name in $names; do cat "$LOGS/$name/rows.jsonl"; done | jq -rs '[.[].commit] | unique | join(", ")'; }

compare() {  # VARIANT: drive by drive with geometric
  "$BUILD/bin/rover_campaign" compare $LOGS/geometric "$LOGS/$1" --out "$LOGS/$1/compare_geometric.md" >/dev/null
  sed 's/^#/##/' "$LOGS/$1/compare_geometric.md"
}

while IFS='|' read -r name scenarios changes; do
  drive "$name" "$scenarios" "$changes" </dev/null
done < <(variants)
{
  echo "# What the path costs: the map or the policy"
  echo
  echo "Command: \`$COMMAND\`; commit $(commits); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores; seeds $SEEDS of truth and geometric, else $FEW_SEEDS."
  for scenario in full_hard seed_traverse_2; do
    echo
    echo "## \`$scenario\`, level $(level_of "$scenario")"
    echo
    table "$scenario"
  done
  echo
  echo "Ratio: driven / planned, of the drives at the goal; regret: driven / shortest drivable path. Areas: cells called impassable over true area of 0.15 m and more, within 4 m. From 'straight' on: percent of the time."
  echo
  echo "Variants:"
  echo
  variants | while IFS='|' read -r name scenarios changes; do echo "* \`$name\`: $changes"; done
  for variant in $(variants | sed -n 's/^\(truth\|rendered\)|.*/\1/p'); do
    echo
    compare $variant
  done
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
