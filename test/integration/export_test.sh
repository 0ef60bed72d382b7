#!/usr/bin/env bash
# ./rover export: tables, trajectories, tracks on the planet, and MCAP that the reference reader accepts (@mcap/core from
# npm; skipped if npm cannot be reached). Bad input gives one line and writes nothing.
. "$(dirname "$0")/lib.sh"
cd "$SOURCE"

default_for 19 "$WORK/short.yaml"
drive "$WORK/run" "$WORK/short.yaml" --headless >/dev/null || true
"$BUILD/bin/rover_export" "$WORK/run" >"$WORK/out" || fail "export: $(cat "$WORK/out")"
out=$WORK/run/export

echo "-- tables"
ticks=$(($(wc -l <"$out/csv/TICK.csv") - 1))
poses=$(($(wc -l <"$out/csv/POSE.csv") - 1))
[ "$ticks" -gt 300 ] && [ $((ticks - poses)) -le 3 ] || fail "$ticks ticks, $poses poses"
head -1 "$out/csv/POSE.csv" | grep -q "^header.utime,.*,position_odom_body_m\[0\]," || fail "no header"
python3 - "$out/csv" <<'PYTHON' || fail "the tables cannot be read"
import csv, glob, sys
for name in glob.glob(sys.argv[1] + "/*.csv"):
    rows = list(csv.reader(open(name, newline="")))
    assert len(rows) > 1 and all(len(row) == len(rows[0]) for row in rows), name
PYTHON

echo "-- trajectories"
for name in truth estimate odometry; do
  awk 'NF != 8 || $1 <= last { exit 1 } { last = $1 }' "$out/tum/$name.txt" || fail "$name.txt is not a trajectory"
done

echo "-- tracks"
jq -e '.type == "FeatureCollection" and (.features | map(.properties.track) | contains(["truth", "estimate", "global_path"]))
  and (.features[0].geometry.coordinates[0] | .[0] > 130 and .[0] < 140 and .[1] > -6 and .[1] < -4)' \
  "$out/tracks.geojson" >/dev/null || fail "no tracks in Gale crater: $(head -c 600 "$out/tracks.geojson")"

echo "-- MCAP"
if command -v npm >/dev/null && (cd "$WORK" && timeout 180 npm install --silent --no-audit --no-fund --prefix "$WORK/npm" @mcap/core@2) >/dev/null 2>&1; then
  cat >"$WORK/npm/read.mjs" <<'JS'
import fs from "node:fs/promises";
import zlib from "node:zlib";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

const path = process.argv[2];
const bytes = await fs.readFile(path);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
};
const indexed = await McapIndexedReader.Initialize({ readable });
const topics = new Map([...indexed.channelsById.values()].map((channel) => [channel.topic, channel]));
const counts = {};
let last = 0n;
for await (const message of indexed.readMessages()) {
  const channel = indexed.channelsById.get(message.channelId);
  if (message.logTime < last) throw new Error("times fall");
  last = message.logTime;
  const value = JSON.parse(new TextDecoder().decode(message.data));
  const schema = JSON.parse(new TextDecoder().decode(indexed.schemasById.get(channel.schemaId).data));
  for (const key of Object.keys(value)) if (!(key in schema.properties)) throw new Error(`${channel.topic}: ${key} has no schema`);
  counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
}
for (const [topic, channel] of topics)
  if (BigInt(counts[topic]) !== indexed.statistics.channelMessageCounts.get(channel.id)) throw new Error(`${topic}: count`);
// The same without the index, checksums included.
const stream = new McapStreamReader({ validateCrcs: true });
stream.append(new Uint8Array(bytes));
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) if (record.type === "Message") streamed += 1;
if (!stream.done() || BigInt(streamed) !== indexed.statistics.messageCount) throw new Error(`streamed ${streamed}`);
console.log(JSON.stringify(counts));
JS
  node "$WORK/npm/read.mjs" "$out/traverse.mcap" >"$WORK/counts" || fail "the reader refuses the file"
  jq -e --argjson poses "$poses" '.["/POSE"] == $poses and .["/tf"] > 100 and .["/LOCCAM_LEFT"] >= 15 and .["/DISPARITY"] >= 10' \
    "$WORK/counts" >/dev/null || fail "counts: $(cat "$WORK/counts")"
  echo "read by @mcap/core: $(jq add "$WORK/counts") messages"
else
  echo "skipped: npm cannot be reached, the MCAP file was not tested with the reference reader"
fi

echo "-- bad input"
# refused NAME PATTERN ARGS...
refused() {
  local name=$1 pattern=$2 code=0
  shift 2
  "$BUILD/bin/rover_export" "$@" >/dev/null 2>"$WORK/said" || code=$?
  [ $code = 2 ] && [ "$(wc -l <"$WORK/said")" = 1 ] && grep -q "$pattern" "$WORK/said" || fail "$name: $code: $(cat "$WORK/said")"
}
sum=$(find "$out" -type f | sort | xargs cat | sha256sum)
refused "a folder that is there" "already exists" "$WORK/run"
[ "$sum" = "$(find "$out" -type f | sort | xargs cat | sha256sum)" ] || fail "it was written to"
refused "no log" "no such log" "$WORK/none.lcm"
refused "an unknown format" "no format 'bag'" "$WORK/run" --format bag --out "$WORK/new"
refused "an unknown channel" "no channel 'POSES'" "$WORK/run" --channels POSES --out "$WORK/new"
[ ! -e "$WORK/new" ] || fail "something was left"
echo "the log is exported to all formats"
