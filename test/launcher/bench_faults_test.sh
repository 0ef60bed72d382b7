#!/usr/bin/env bash
# test/bench_faults.sh with made-up drives: an interrupted or crashed drive has no row, and then there is no table.
. "$(dirname "$0")/../integration/lib.sh"

mkdir -p "$WORK"/{test,config/scenarios,build/bin}
cp "$SOURCE"/test/bench_{faults,lib}.sh "$WORK/test/"
cp "$SOURCE/config/scenarios/default.yaml" "$WORK/config/scenarios/"
git -C "$WORK" init -q
git -C "$WORK" -c user.name=a -c user.email=a@b commit -qm first --allow-empty
cat >"$WORK/build/bin/rover_launcher" <<'SH'
#!/bin/bash
while [ $# -gt 1 ]; do
  case $1 in
    --seed) seed=$2 ;;
    --out) out=$2 ;;
  esac
  shift
done
outcome=goal_reached
[ $seed != 2 ] || [ -e "$0.again" ] || outcome=stopped
[ $seed != 3 ] || [ -e "$0.again" ] || exit 1
mkdir -p "$out"
echo "{\"outcome\": \"$outcome\", \"fdir\": [], \"collisions\": 0}" >"$out/metrics.json"
SH
chmod +x "$WORK/build/bin/rover_launcher"

bench() { "$WORK/test/bench_faults.sh" "$WORK/build" --part rendered --seeds 1..4 "$@"; }
rows=$WORK/logs/bench/faults/rows.jsonl
status=0
bench >"$WORK/out" 2>"$WORK/said" || status=$?
[ "$(jq -s 'map(.seed) | sort' -c "$rows")" = "[1,4]" ] || fail "rows: $(cat "$rows")"
[ $status = 1 ] && grep -q "no row of seed 2 3: no table; continue with --resume" "$WORK/said" || fail "said: $(cat "$WORK/said")"
[ ! -e "$WORK/test/results/faults.md" ] || fail "a table of a part"
touch "$WORK/build/bin/rover_launcher.again"
bench --resume >"$WORK/out" 2>"$WORK/said" || fail "resumed: $(cat "$WORK/said")"
grep -q "| runs; faults in them | 4; 8 |" "$WORK/test/results/faults.md" || fail "table: $(cat "$WORK/test/results/faults.md")"
echo "bench faults: interrupted and crashed drives are repeated"
