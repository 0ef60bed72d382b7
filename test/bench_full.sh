#!/usr/bin/env bash
# The Full level, alone and combined with the Efficient level: full_hard at both levels, combined_500 and
# long_drift. Each run is one line of logs/bench/full/rows.jsonl, keyed by commit, scenario, level and seed; --resume keeps
# those of this commit. Writes test/results/full.md.
# Called by ./rover bench full: BUILD [--resume] [--jobs N] [--seeds 1..5].
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
shift
OUT=test/results/full.md
LOGS=$PWD/logs/bench/full
ROWS=$LOGS/rows.jsonl
. test/bench_lib.sh
COMMIT=$(program_commit)
resume=no jobs=1 seeds=1..5
while [ $# -gt 0 ]; do
  case $1 in
    --resume) resume=yes ;;
    --jobs | --seeds)
      [ $# -gt 1 ] || { echo "bench full: $1 needs a value" >&2; exit 2; }
      [ "$1" = --jobs ] && jobs=$2 || seeds=$2
      shift
      ;;
    *)
      echo "bench full: '$1' is not an option; known options: --resume, --jobs N, --seeds A..B" >&2
      exit 2
      ;;
  esac
  shift
done
[[ $jobs =~ ^[1-9][0-9]?$ ]] || { echo "bench full: --jobs: '$jobs' is not a number from 1 to 99" >&2; exit 2; }
[[ $seeds =~ ^([0-9]+)\.\.([0-9]+)$ ]] || { echo "bench full: --seeds: '$seeds' is not a range like 1..5" >&2; exit 2; }
command="./rover bench full --seeds $seeds"
seeds=$(seq "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}")
mkdir -p test/results "$LOGS"
[ $resume = yes ] || : >"$ROWS"
touch "$ROWS"

# run SCENARIO LEVEL SEED PORT
run() {
  local dir=$LOGS/$1-$2-$3 status=0
  rm -rf "$dir"
  "$BUILD/bin/rover_launcher" run "config/scenarios/$1.yaml" --level "$2" --seed "$3" --record reduced --headless \
    --out "$dir" --bus "udpm://239.255.76.67:$4?ttl=0&recv_buf_size=4194304" >"$dir.txt" 2>&1 || status=$?
  [ -e "$dir/metrics.json" ] || { echo "$1 $2 seed $3: no metrics, see $dir.txt" >&2; return; }
  [ "$(jq -r .outcome "$dir/metrics.json")" != stopped ] || return 0  # the bench was interrupted
  jq -c --arg commit "$COMMIT" --arg level "$2" --argjson status $status \
    '.commit = $commit | .level = $level | .exit_status = $status' "$dir/metrics.json" >>"$ROWS"
  echo "$1 $2 seed $3: $(jq -r .outcome "$dir/metrics.json")" >&2
}
has_row() {
  jq -e -s --arg c "$COMMIT" --arg s "$1" --arg l "$2" --argjson n "$3" \
    'any(.[]; .commit == $c and .scenario == $s and .level == $l and .seed == $n)' "$ROWS" >/dev/null
}

wanted() {
  local seed
  for seed in $seeds; do
    echo "full_hard auto $seed"
    echo "full_hard efficient $seed"
  done
  echo "long_drift full 1"
  echo "combined_500 auto 1"
  echo "combined_500 auto 2"
}

# Each job has its own port, and so its own bus.
port=17800
while read -r scenario level seed; do
  has_row "$scenario" "$level" "$seed" && continue
  while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || true; done
  port=$((port + 1))
  run "$scenario" "$level" "$seed" $port &
done < <(wanted)
wait
# A drive that crashed must not make the table better.
missing=
while read -r scenario level seed; do has_row "$scenario" "$level" "$seed" || missing+=" $scenario-$level-$seed"; done < <(wanted)
[ -z "$missing" ] || { echo "rover bench full: no row of$missing: no table; continue with --resume" >&2; exit 1; }

rows() { jq -s --arg c "$COMMIT" 'map(select(.commit == $c))' "$ROWS"; }
{
  echo "# The Full level, and both levels combined"
  echo
  echo "Command: \`$command\`; commit $COMMIT; $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  rows | jq -r -f test/bench_full.jq
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
