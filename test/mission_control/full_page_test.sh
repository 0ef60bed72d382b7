#!/usr/bin/env bash
# full_page_test.sh MADE_UP_PAGE: the page of a made-up drive at the Full level in a browser. Pictures go to ROVER_PICTURES where that is set.
. "$(dirname "$0")/../integration/lib.sh"

for program in chromium chromedriver; do
  command -v "$program" >/dev/null || fail "$program is missing; ./rover test installs it"
done
PAGE_PORT=$((PORT + 20002))
"$1" "$PAGE_PORT" &
PAGE=$!
until curl -sfo /dev/null "http://127.0.0.1:$PAGE_PORT/"; do
  kill -0 "$PAGE" || fail "the page ended before it was served"
  sleep 0.1
done
/usr/bin/python3 "$(dirname "$0")/full_page_test.py" --port "$PAGE_PORT" --pictures "${ROVER_PICTURES:-$WORK}" ||
  fail "the page of the Full level"
echo "the page shows the Full level"
