#!/usr/bin/env bash
# CPU time of the page: runs of `default` (simulator and services) without a page (--headless), with a served page, and
# with the page open in a browser, in turns. The browser's own time does not count: it runs on the operator's machine. Writes test/results/page.md. Called by ./rover bench page [ROUNDS].
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
ROUNDS=${2:-3}
PORT=8090
BUS='udpm://239.255.76.67:7690?ttl=0&recv_buf_size=4194304'
OUT=test/results/page.md
LOGS=logs/bench/page
[[ $ROUNDS =~ ^[1-9][0-9]?$ ]] || { echo "bench page: '$ROUNDS' is not a number of rounds, as in: ./rover bench page 3" >&2; exit 2; }
command -v chromium >/dev/null || { echo "bench page: chromium is missing; install it with: apt-get install chromium" >&2; exit 2; }
mkdir -p test/results "$LOGS"
profile=$(mktemp -d -t rover-browser-XXXXXX)
browser=
close_browser() {
  [ -z "$browser" ] || kill -- "-$browser" 2>/dev/null || true
  browser=
}
trap 'close_browser; rm -rf "$profile"' EXIT

open_browser() {
  setsid chromium --headless --no-sandbox --disable-gpu --user-data-dir="$profile" --remote-debugging-port=0 \
    --window-size=1440,900 "http://127.0.0.1:$PORT/" >/dev/null 2>&1 &
  browser=$!
}

# CPU seconds used by a process.
cpu_of() { awk -v hz="$(getconf CLK_TCK)" '{ sub(/.*\) /, ""); print ($12 + $13) / hz }' "/proc/$1/stat" 2>/dev/null || echo 0; }

drive() {  # KIND ROUND ARGS...
  local dir=$LOGS/$1-$2 simulator= simulator_s=0 launcher now
  rm -rf "${dir:?}"
  "$BUILD/bin/rover_launcher" run "${@:3}" --out "$dir" --bus "$BUS" --record reduced --set mission_control.port="$PORT" >"$dir.log" &
  launcher=$!
  while kill -0 "$launcher" 2>/dev/null; do
    if [ "$1" = open ] && [ -z "$browser" ] && curl -sfo /dev/null "http://127.0.0.1:$PORT/"; then open_browser; fi
    [ -n "$simulator" ] || simulator=$(s6-svstat -o pid "$dir/services/rover_simulator" 2>/dev/null | grep -v '^-1' || true)
    [ -z "$simulator" ] || { now=$(cpu_of "$simulator"); [ "$now" = 0 ] || simulator_s=$now; }
    sleep 0.1
  done
  wait "$launcher"
  close_browser
  jq -c --arg kind "$1" --argjson simulator "$simulator_s" \
    '{kind: $kind, services: ([.services[].cpu_s] | add), own: .services.mission_control.cpu_s, simulator: $simulator}' "$dir/metrics.json" | tee -a "$LOGS/rows.jsonl"
}

rm -f "$LOGS/rows.jsonl"
for round in $(seq "$ROUNDS"); do
  drive without "$round" --headless
  drive served "$round"
  drive open "$round"
done

# In lockstep the other programs do the same work in each run, and their variation is larger than the effect. So the cost
# is the CPU time of mission_control relative to the whole run without a page.
jq -rs --arg commit "$(git describe --always --dirty --abbrev=12)" --arg cpu "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores" '
  def median: sort | .[length / 2 | floor];
  def of($kind; f): map(select(.kind == $kind) | f) | median;
  def r: . * 100 | round / 100;
  of("without"; .services + .simulator) as $whole | of("without"; .own) as $own |
  "# CPU cost of the page\n\nCommand: `./rover bench page`; commit \($commit); \($cpu). Medians of \(map(select(.kind == "open")) | length) runs of `default`.\n\n" +
  "| | whole run, CPU s | mission_control, CPU s | added, of the whole run |\n|---|---|---|---|\n" +
  "| no page (`--headless`) | \($whole | r) | \($own | r) | |\n" +
  "| served, not open (required: at most 0.5 %) | \(of("served"; .services + .simulator) | r) | \(of("served"; .own) | r) | \((of("served"; .own) - $own) / $whole * 100 | r) % |\n" +
  "| open in a browser (required: at most 5 %) | \(of("open"; .services + .simulator) | r) | \(of("open"; .own) | r) | \((of("open"; .own) - $own) / $whole * 100 | r) % |"
' "$LOGS/rows.jsonl" >$OUT.new
mv $OUT.new $OUT
cat $OUT
