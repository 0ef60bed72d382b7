#!/usr/bin/env bash
# Every service is killed in turn while the rover drives in real time, and at the end the simulator: how long each is
# away, and when the wheels are told to stop. Writes test/results/restarts.md.
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
  wait $run || true  # its clock was killed
done

{
  echo "# Services killed while the rover drives in real time"
  echo
  echo "Command: \`./rover bench restarts\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  jq -rs '
    def worst(k): [.[][k] | select(. >= 0)] | if length == 0 then "-" else max * 1000 | round / 1000 end;
    def middle(k): [.[][k] | select(. >= 0)] | if length == 0 then "-" else (sort | .[length / 2 | floor]) * 1000 | round / 1000 end;
    def missing(k): map(select(.[k] < 0)) | length;
    map(select(.service != "rover_simulator")) as $kills | map(select(.service == "rover_simulator")) as $clock |
    ($kills | map(select(.service == "supervisor"))) as $supervisor |
    "| demand | measured |", "|---|---|",
    "| kills of a service | \($kills | length) |",
    "| from SIGKILL to the first message of the new process at most 1 s (99 %) | median \($kills | middle("first_message_s")) s, largest \($kills | worst("first_message_s")) s, \($kills | missing("first_message_s")) did not come back |",
    "| the drive goes on without a person | \($kills | length - ($kills | missing("drives_again_s"))) of \($kills | length), largest \($kills | worst("drives_again_s")) s |",
    "| supervisor killed: the wheels are told to stop within 0.3 s of message time | largest \($supervisor | worst("stop_begun_s")) s; still commanded after \($supervisor | worst("still_s")) s |",
    "| simulator killed: no permit after 0.5 s of wall time | largest \($clock | worst("withdrawn_s")) s of \($clock | length) |",
    "", "| service | kills | first message, median [s] | largest [s] | drives on after, median [s] | largest [s] |", "|---|---|---|---|---|---|",
    ($kills | group_by(.service)[] | "| \(.[0].service) | \(length) | \(middle("first_message_s")) | \(worst("first_message_s")) | \(middle("drives_again_s")) | \(worst("drives_again_s")) |")' "$LOGS/rows.jsonl"
} >"$OUT"
cat "$OUT"
