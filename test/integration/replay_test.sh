#!/usr/bin/env bash
# ./rover replay --check: every service publishes identical bytes. A flipped input byte is detected, and the first
# differing message is reported. A replay with live services records a new log. Bad input gives one line.
. "$(dirname "$0")/lib.sh"
cd "$SOURCE"

replay() { "$BUILD/bin/rover_launcher" replay "$@" --bus "$BUS"; }
# refused NAME PATTERN ARGS...
refused() {
  local name=$1 pattern=$2 code=0
  shift 2
  replay "$@" --out "$WORK/refused" >/dev/null 2>"$WORK/said" || code=$?
  [ $code = 2 ] || fail "$name: exit status $code, said: $(cat "$WORK/said")"
  [ "$(wc -l <"$WORK/said")" = 1 ] || fail "$name: not one line: $(cat "$WORK/said")"
  grep -qE "$pattern" "$WORK/said" || fail "$name: said: $(cat "$WORK/said")"
  [ ! -e "$WORK/refused" ] || fail "$name: leaves a folder"
}

default_for 21 "$WORK/short.yaml"
drive "$WORK/run" "$WORK/short.yaml" --headless >/dev/null || true
[ -s "$WORK/run/traverse.lcm" ] || fail "no log"

echo "-- every service, byte by byte"
replay "$WORK/run" --check --out "$WORK/check" >"$WORK/out" || fail "differs from its own log: $(cat "$WORK/out")"
grep -q "of 8 services byte-identical" "$WORK/out" || fail "not of all services: $(cat "$WORK/out")"
for channel in DISPARITY VO POSE SLIP HAZARDS PLANNER_STATUS MOTION_COMMAND WHEEL_COMMAND STATE; do
  grep -qE "^$channel .* [1-9][0-9]* identical$" "$WORK/out" || fail "$channel was not compared: $(cat "$WORK/out")"
done
grep -q "times real time" "$WORK/out" || fail "no speed"

echo "-- one flipped byte of an image"
cp -r "$WORK/run" "$WORK/flipped"
# The tenth image of the left camera, 100000 bytes before its end.
python3 - "$WORK/flipped/traverse.lcm" <<'PYTHON'
import struct, sys
log = bytearray(open(sys.argv[1], "rb").read())
at = 0
seen = 0
while at < len(log):
    _, _, _, name_size, size = struct.unpack(">IqqII", log[at:at + 28])
    name = bytes(log[at + 28:at + 28 + name_size])
    end = at + 28 + name_size + size
    if name == b"LOCCAM_LEFT":
        seen += 1
        if seen == 10:
            log[end - 100000] ^= 0x80
            break
    at = end
assert seen == 10
open(sys.argv[1], "wb").write(log)
PYTHON
code=0
replay "$WORK/flipped" --check --out "$WORK/check2" >"$WORK/out" || code=$?
[ $code = 1 ] || fail "a flipped byte: exit status $code: $(cat "$WORK/out")"
grep -qE "^first difference: (LOCCAM_RECT_LEFT|DISPARITY) of stereo, seq 10, " "$WORK/out" ||
  fail "reports another message: $(cat "$WORK/out")"
grep -qE "^LOCCAM_RECT_LEFT +stereo +9 identical, then .*data\[" "$WORK/out" || fail "no field: $(cat "$WORK/out")"
grep -qE "^WHEEL_COMMAND .* [1-9][0-9]* identical" "$WORK/out" || fail "no result of the others: $(cat "$WORK/out")"

echo "-- some services live, with another setting, recorded in a new log"
replay "$WORK/run" --services stereo,visual_odometry --speed max --set stereo.matcher.block_px=9 --out "$WORK/live" \
  >"$WORK/out" || fail "live services: $(cat "$WORK/out")"
code=0
replay "$WORK/live" --check --services stereo,visual_odometry --out "$WORK/check3" >"$WORK/out" || code=$?
[ $code = 0 ] || fail "the new log does not repeat: $(cat "$WORK/out")"
cmp -s "$WORK/run/traverse.lcm" "$WORK/live/traverse.lcm" && fail "the setting changed nothing"

echo "-- bad input"
refused "no log" "none.lcm: no such log" "$WORK/none.lcm"
echo "text" >"$WORK/text.lcm"
refused "no log inside" "contains no messages" "$WORK/text.lcm"
refused "an unknown service" "no service 'sterio'; known services: " "$WORK/run" --services sterio
refused "after the end" "from: after the end" "$WORK/run" --from 1000
refused "an invalid speed" "speed fast" "$WORK/run" --speed fast
refused "a bad setting" "stereo.yaml with --set: .*block_px" "$WORK/run" --services stereo --set stereo.matcher.block_px=8
mkdir "$WORK/full" && touch "$WORK/full/file"
code=0
replay "$WORK/run" --services stereo --out "$WORK/full" 2>"$WORK/said" || code=$?
[ $code = 2 ] && grep -q "already exists" "$WORK/said" || fail "a folder that is there: $code $(cat "$WORK/said")"
[ "$(ls "$WORK/full")" = file ] || fail "the folder was written to"
echo "replay repeats what was recorded"
