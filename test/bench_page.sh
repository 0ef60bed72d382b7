#!/usr/bin/env bash
# What the page costs: processor time of all of the rover's services on the scenario `default`, without a page (--headless), with
# one that is served but not open, and with one open in a browser; one run at a time, in turns. Processor time of the browser does not
# count: it runs on the operator's machine. Writes test/results/page.md. Called by ./rover bench page.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
ROUNDS=${2:-3}
PORT=${ROVER_PAGE_PORT:-8090}
BUS='udpm://239.255.76.67:7690?ttl=0&recv_buf_size=4194304'
OUT=test/results/page.md
LOGS=logs/bench/page
mkdir -p test/results "$LOGS"
command -v chromium >/dev/null || { echo "bench page: chromium is missing; ./rover test installs it" >&2; exit 2; }

browser=
profile=$(mktemp -d /tmp/rover-browser-XXXXXX)
close_browser() {
  [ -z "$browser" ] || { kill -- "-$browser" 2>/dev/null || true; wait "$browser" 2>/dev/null || true; }
  browser=
}
trap 'close_browser; rm -rf "$profile"' EXIT

open_browser() {
  until curl -sfo /dev/null "http://127.0.0.1:$PORT/"; do sleep 0.1; done
  setsid chromium --headless --no-sandbox --disable-gpu --user-data-dir="$profile" --remote-debugging-port=0 \
    --window-size=1440,900 "http://127.0.0.1:$PORT/" >/dev/null 2>&1 &
  browser=$!
}

drive() {  # KIND ROUND ARGS...
  local dir=$LOGS/$1-$2 opener=
  rm -rf "${dir:?}"
  if [ "$1" = open ]; then
    open_browser & opener=$!
    wait_for_run "$dir" "${@:3}"
    wait "$opener" 2>/dev/null || true
  else
    wait_for_run "$dir" "${@:3}"
  fi
  echo "$1 $2: $(total "$1-$2") s of processor time, mission_control $(own "$1-$2") s" >&2
}
wait_for_run() { "$BUILD/bin/rover_launcher" run "${@:2}" --out "$1" --bus "$BUS" --record reduced --set mission_control.port="$PORT" >"$1.log"; }
total() { jq '[.services[].cpu_s] | add' "$LOGS/$1/metrics.json"; }
own() { jq '.services.mission_control.cpu_s' "$LOGS/$1/metrics.json"; }
