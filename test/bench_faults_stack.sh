#!/usr/bin/env bash
# Injects every row of config/fdir.yaml repeatedly into a stack in one long-lived process. Writes
# test/results/faults_stack.md; keeps the log if a requirement is not met. Called by bench_faults.sh: BUILD [SEED].
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
seed=${2:-1}
OUT=$PWD/logs/bench/faults/stack
TABLE=test/results/faults_stack.md
COMMIT=$(git describe --always --dirty --abbrev=12)
MACHINE="$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores"
mkdir -p "$OUT" test/results

"$BUILD/bench_faults/fault_stack" --seed "$seed" --out "$OUT" >"$OUT.log"
tail -1 "$OUT.log"
met=0
"$BUILD/bench_faults/fault_judge" --log "$OUT/stack.lcm" --out "$TABLE" --commit "$COMMIT" --machine "$MACHINE" \
  --command "./rover bench faults --part stack" || met=$?
cat "$TABLE"
[ "$met" != 0 ] || rm -f "$OUT/stack.lcm"
exit "$met"
