#!/usr/bin/env bash
# ./rover conform on a live bus: the example driver's table, no driver, a stack on the bus. Checks that depend on the
# machine's load (jitter, pace, image latency) are tested in conform_test with simulated time, not here.
. "$(dirname "$0")/lib.sh"
cd "$SOURCE"
conform() { "$BUILD/bin/rover_conform" --bus "$BUS" "$@"; }

status=0
"$BUILD/bin/rover_conform" --bus "$BUS" --listen 0.1 >/dev/null 2>&1 || status=$?
[ $status = 2 ] || fail "a bad option: exit status $status"
status=0
conform >/dev/null 2>"$WORK/said" || status=$?
[ $status = 2 ] || fail "no driver: exit status $status"
grep -q "no TICK within 10 s. Start the driver" "$WORK/said" || fail "no driver: $(cat "$WORK/said")"

"$BUILD/bin/example_driver" --bus "$BUS" --pace 0.5 >"$WORK/driver.txt" &
driver=$!
conform --move --listen 4 >"$WORK/table" || true
cat "$WORK/table"
grep -q "WARNING: the rover will move" "$WORK/table" || fail "moved without a warning"
for duty in types "rate of IMU" "rate of WHEEL_STATE" utime seq boot "IMU interval" gravity gyros "wheels at rest" \
  "image size" pairs exposure "left and right" "damaged commands" "commands with NaN" steering "sense of turn"; do
  grep -q "^pass  $duty  " "$WORK/table" || fail "$duty: $(grep "$duty" "$WORK/table")"
done
kill $driver
wait $driver || true
grep -q BAD_MESSAGE "$WORK/driver.txt" || fail "the driver received no damaged command"
echo "the conformance test checks a live driver"
