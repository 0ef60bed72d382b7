#!/usr/bin/env bash
# Two faults of the table, a minute apart, in each of many runs of the default scenario; the seed selects them. Writes
# test/results/faults.md. Called by ./rover bench faults [--seeds a..b] [--resume] [--jobs N] [--part stack|rendered];
# part `stack` is bench_faults_stack.sh; without --part both run, stack first.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
shift
seeds=1..30 resume= jobs=2 part=
while [ $# -gt 0 ]; do
  case $1 in
    --resume) resume=yes ;;
    --seeds | --jobs | --part)
      [ $# -gt 1 ] || { echo "rover bench faults: $1 needs a value" >&2; exit 2; }
      printf -v "${1#--}" %s "$2"
      shift
      ;;
    *) echo "rover bench faults: '$1' is not an option" >&2 && exit 2 ;;
  esac
  shift
done
[[ $jobs =~ ^[1-9][0-9]?$ ]] || { echo "rover bench faults: --jobs: '$jobs' is not a number from 1 to 99" >&2; exit 2; }
[[ $seeds =~ ^([1-9][0-9]{0,8})\.\.([1-9][0-9]{0,8})$ ]] || { echo "rover bench faults: --seeds: '$seeds' is not a range like 1..30" >&2; exit 2; }
first=${BASH_REMATCH[1]} last=${BASH_REMATCH[2]}
case $part in
  "") test/bench_faults_stack.sh "$BUILD" ;;
  stack) exec test/bench_faults_stack.sh "$BUILD" ;;
  rendered) ;;
  *) echo "rover bench faults: '$part' is not a part; known parts: stack, rendered" >&2 && exit 2 ;;
esac
LOGS=$PWD/logs/bench/faults
ROWS=$LOGS/rows.jsonl
OUT=test/results/faults.md
. test/bench_lib.sh
COMMIT=$(program_commit)
mkdir -p "$LOGS" test/results
[ -n "$resume" ] || rm -f "$ROWS"
touch "$ROWS"

# fault, target, amount ("-": default), duration ("-": none)
CASES=(
  "kill recorder - -" "kill stereo - -" "kill visual_odometry - -" "kill localization - -" "kill hazard_detector - -"
  "kill path_planner - -" "kill trajectory_control - -" "kill locomotion - -" "kill supervisor - -"
  "kill mission_control - -" "hang stereo - -" "hang localization - -" "hang path_planner - -" "hang locomotion - -"
  "hang supervisor - -" "restart_loop hazard_detector 2 -" "slow stereo 0.5 5" "drop POSE 1 2" "drop DISPARITY 1 3"
  "delay HAZARDS 1 5" "duplicate IMU 1 5" "reorder POSE 0.3 5" "corrupt VO 0.5 5" "freeze DISPARITY - 3"
  "nan POSE 1 2" "nan VO 1 3" "loss * 0.02 20" "loss * 0.2 5" "camera_blind both - 3" "camera_frozen both - 3"
  "camera_rows left 3 4" "imu_dead imu - 2" "gyro_bias imu 0.05 5" "encoder_stuck 2 - 5" "wheel_jammed 3 - 4"
  "loose_sand ground - 8" "tilt_roll ground 25 4" "tilt_pitch ground 40 4" "clock_step clock 0.8 -"
  "full_disk recorder - 10"
)

# The runs cycle through the table, so that a fault repeats at another time and with another partner.
case_of() { echo "${CASES[$((($1 - 1) % ${#CASES[@]}))]}"; }

fault_line() {  # AT FAULT TARGET AMOUNT FOR
  local keys="fault: $2, target: '$3', at_s: $1"
  [ "$4" = - ] || keys="$keys, amount: $4"
  [ "$5" = - ] || keys="$keys, for_s: $5"
  echo "  - {$keys}"
}

# The rock area of the second seed traverse, where a rover without faults reaches its goal: a run that does not was
# stopped by its faults.
ROCK_AREA_K=0.05

scenario_of() {  # SEED: the default scenario with the faults and times of this seed
  sed "s/rock_area_k: [0-9.]*/rock_area_k: $ROCK_AREA_K/" config/scenarios/default.yaml
  echo "faults:"
  set -f  # a target may be *
  # shellcheck disable=SC2046
  fault_line $((15 + $1 * 37 % 40)) $(case_of $((2 * $1 - 1)))
  # shellcheck disable=SC2046
  fault_line $((75 + $1 * 23 % 40)) $(case_of $((2 * $1)))
  set +f
}

run_one() {  # SEED
  local seed=$1 dir="$LOGS/run-$1" fault
  fault="$(case_of $((2 * seed - 1))); $(case_of $((2 * seed)))"
  rm -rf "$dir"
  scenario_of "$seed" >"$LOGS/seed-$seed.yaml"
  sed -i "s|\.\./terrain|$PWD/config/terrain|" "$LOGS/seed-$seed.yaml"
  "$BUILD/bin/rover_launcher" run "$LOGS/seed-$seed.yaml" --seed "$seed" --out "$dir" --record reduced \
    --bus "udpm://239.255.76.67:$((7900 + seed))?ttl=0&recv_buf_size=4194304" >"$LOGS/seed-$seed.log" 2>&1 || true
  [ -e "$dir/metrics.json" ] || { echo "seed $seed: $fault: no metrics, see $LOGS/seed-$seed.log" >&2; return; }
  [ "$(jq -r .outcome "$dir/metrics.json")" != stopped ] || return 0  # the bench was interrupted
  jq -c --arg fault "$fault" --arg commit "$COMMIT" --argjson seed "$seed" \
    '{commit: $commit, seed: $seed, fault: $fault, outcome, collisions, deterministic, duration_s,
      unleased_s: .motion_without_lease_s, rows: [.fdir[].id] | unique, first: (.fdir[0].id // "-"), last: (.fdir[-1].id // "-")}' "$dir/metrics.json" >>"$ROWS"
  [ "$(jq -r .outcome "$dir/metrics.json")" != goal_reached ] || rm -f "$dir/traverse.lcm"  # else keep it for analysis
  echo "seed $seed: $fault: $(jq -r .outcome "$dir/metrics.json")"
}

has_row() { grep -q "\"commit\":\"$COMMIT\",\"seed\":$1," "$ROWS"; }

for ((seed = first; seed <= last; ++seed)); do
  has_row "$seed" && continue
  while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
  run_one "$seed" &
done
wait
# A drive that crashed must not make the table better.
missing=
for ((seed = first; seed <= last; ++seed)); do has_row "$seed" || missing+=" $seed"; done
[ -z "$missing" ] || { echo "rover bench faults: no row of seed$missing: no table; continue with --resume" >&2; exit 1; }

{
  echo "# Faults on the whole, rendered rover"
  echo
  echo "Command: \`./rover bench faults --seeds $first..$last\`; commit $COMMIT; $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  echo "Two faults in each run of the default scenario (rocks of k = $ROCK_AREA_K), a minute apart, without operator commands."
  echo
  jq -rs --arg commit "$COMMIT" '
    map(select(.commit == $commit)) |
    "| requirement | measured |", "|---|---|",
    "| runs; faults in them | \(length); \(2 * length) |",
    "| 0 collisions | \(map(.collisions // 0) | add) |",
    "| at least 95 % reach the goal without an operator | \(map(select(.outcome == "goal_reached")) | length) of \(length) |",
    "| 0 s of true motion without a lease | \(map(.unleased_s // 0) | add) s |",
    "", "| seed | faults: type, target, amount, seconds | outcome | first row | last row | collisions | deterministic | s |", "|---|---|---|---|---|---|---|---|",
    (sort_by(.seed)[] | "| \(.seed) | \(.fault) | \(.outcome) | \(.first) | \(.last) | \(.collisions // "-") | \(.deterministic) | \(.duration_s // 0 | round) |")' "$ROWS"
} >"$OUT"
cat "$OUT"
