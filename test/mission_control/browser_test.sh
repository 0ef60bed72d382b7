#!/usr/bin/env bash
# The page in a browser, on a live run: browser_test.py drives Chromium. Pictures go to ROVER_PICTURES where that is set.
. "$(dirname "$0")/../integration/lib.sh"

for program in chromium chromedriver; do
  command -v "$program" >/dev/null || fail "$program is missing; ./rover test installs it"
done
PAGE_PORT=$((PORT + 20001))
RUN=$WORK/run
(cd "$SOURCE" && exec "$BUILD/bin/rover_launcher" run config/scenarios/seed_traverse_1.yaml --out "$RUN" --bus "$BUS" \
  --record reduced --allow-injection --set mission_control.port="$PAGE_PORT") >"$WORK/run.log" 2>&1 &
launcher=$!
while [ ! -e "$RUN/boots/mission_control" ]; do
  kill -0 "$launcher" || { cat "$WORK/run.log" >&2; fail "no run"; }
  sleep 0.02
done
begun=$(date +%s.%N)
until curl -sfo /dev/null "http://127.0.0.1:$PAGE_PORT/"; do
  kill -0 "$launcher" || { cat "$WORK/run.log" >&2; fail "no page"; }
  sleep 0.02
done
echo "page up $(date +%s.%N) $begun" | awk '{ printf "page up %.2f s after the services were begun\n", $3 - $4 }'
/usr/bin/python3 "$(dirname "$0")/browser_test.py" --port "$PAGE_PORT" --run "$RUN" --pictures "${ROVER_PICTURES:-$WORK}" ||
  { tail -5 "$WORK/run.log"; tail -n 20 "$RUN"/service_logs/{supervisor,rover_simulator}/current; fail "the page in the browser"; } >&2
kill -TERM "$launcher"
wait "$launcher" || true
echo "the page works in a browser"
