#!/usr/bin/env bash
# LCM's own tools work with a run: logger, player with live services, and the jar for the spy.
. "$(dirname "$0")/lib.sh"

lcm-logger --lcm-url="$BUS" "$WORK/beside.lcm" >/dev/null 2>&1 &
logger=$!
six_metres "$WORK/short.yaml"
drive "$WORK/run" "$WORK/short.yaml" --seed 5 --record full || true
sleep 1
kill -INT $logger
wait $logger || true
for log in "$WORK/beside.lcm" "$WORK/run/traverse.lcm"; do
  [ "$(stat -c %s "$log")" -gt 1000000 ] || fail "$log is too small"
done

lcm-logger --lcm-url="$BUS" "$WORK/answers.lcm" >/dev/null 2>&1 &
logger=$!
for service in stereo visual_odometry hazard_detector; do
  "$BUILD/bin/$service" --config "$WORK/run/config" --bus "$BUS" >/dev/null 2>&1 &
done
sleep 1
timeout 8 lcm-logplayer --lcm-url="$BUS" -e 'LOCCAM_(LEFT|RIGHT)|IMU|WHEEL_STATE|TICK' "$WORK/run/traverse.lcm" >/dev/null 2>&1 || true
kill -INT $logger
wait $logger || true
for channel in DISPARITY VO HAZARDS; do
  answers=$(grep -ac "$channel" "$WORK/answers.lcm" || true)
  [ "$answers" -ge 3 ] || fail "$channel: $answers answers to the replayed log"
done

"$SOURCE/lcmtypes/make_jar.sh" "$WORK/types.jar"
unzip -l "$WORK/types.jar" >"$WORK/types.txt"
for type in "$SOURCE"/lcmtypes/*.lcm; do
  name=$(basename "$type" .lcm)
  grep -q "rover/$name.class" "$WORK/types.txt" || fail "the jar lacks $name"
done
echo "logger, player and jar work"
