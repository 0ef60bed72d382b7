#!/usr/bin/env bash
# Kills each service in turn while the rover drives in real time, and finally the simulator. Measures restart times and the
# time until the stop command. Writes test/results/restarts.md.
# Called by ./rover bench restarts.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/restarts.md
LOGS=$PWD/logs/bench/restarts
ROUNDS=2
ninja -C "$BUILD" restart_probe >&2
mkdir -p test/results "$LOGS"
: >"$LOGS/rows.jsonl"
for seed in 1 2 3; do
  bus="udpm://239.255.76.67:$((7990 + seed))?ttl=0&recv_buf_size=4194304"
  rm -rf "${LOGS:?}/run-$seed"
  "$BUILD/bin/rover_launcher" run config/scenarios/seed_traverse_1.yaml --seed $seed --realtime --record reduced \
    --out "$LOGS/run-$seed" --bus "$bus" >"$LOGS/run-$seed.log" 2>&1 &
  run=$!
  "$BUILD/probes/restart_probe" "$LOGS/run-$seed" "$bus" $ROUNDS | tee -a "$LOGS/rows.jsonl" >&2
  wait $run || true  # its clock master was killed
done

{
  echo "# Services killed while the rover drives in real time"
  echo
  echo "Command: \`./rover bench restarts\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  # A drive that ends early (SAFE on a machine that is too busy) leaves kills out.
  jq -rs --argjson due "$((3 * ROUNDS * $(ls -d "$LOGS"/run-1/services/*/ | grep -vc rover_simulator)))" '
    def worst(k): [.[][k] | select(. >= 0)] | if length == 0 then "-" else max * 1000 | round / 1000 end;
    def middle(k): [.[][k] | select(. >= 0)] | if length == 0 then "-" else (sort | .[length / 2 | floor]) * 1000 | round / 1000 end;
    def missing(k): map(select(.[k] < 0)) | length;
    map(select(.service != "rover_simulator")) as $kills | map(select(.service == "rover_simulator")) as $clock |
    ($kills | map(select(.service == "supervisor"))) as $supervisor |
    "| requirement | measured |", "|---|---|",
    "| kills of a service | \($kills | length) of \($due) |",
    "| from SIGKILL to the first message of the new process at most 1 s (99 %) | median \($kills | middle("first_message_s")) s, maximum \($kills | worst("first_message_s")) s, \($kills | missing("first_message_s")) not restarted |",
    "| the drive continues without an operator | \($kills | length - ($kills | missing("drives_again_s"))) of \($kills | length), maximum \($kills | worst("drives_again_s")) s |",
    "| supervisor killed: stop command to the wheels within 0.3 s of message time | maximum \($supervisor | worst("stop_begun_s")) s; stationary by command after \($supervisor | worst("still_s")) s |",
    "| simulator killed: no permit after 0.5 s of wall time | maximum \($clock | worst("withdrawn_s")) s of \($clock | length) |",
    "", "| service | kills | first message, median [s] | maximum [s] | drive continues after, median [s] | maximum [s] |", "|---|---|---|---|---|---|",
    ($kills | group_by(.service)[] | "| \(.[0].service) | \(length) | \(middle("first_message_s")) | \(worst("first_message_s")) | \(middle("drives_again_s")) | \(worst("drives_again_s")) |")' "$LOGS/rows.jsonl"
} >"$OUT.new"
mv "$OUT.new" "$OUT"
cat "$OUT"
