# Sourced by the integration tests: a temporary folder, a separate bus, and cleanup.
set -euo pipefail
SOURCE=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
BUILD=${ROVER_BUILD:-$SOURCE/build}
WORK=$(mktemp -d /tmp/rover-test-XXXXXX)
# Ports by process id, so that tests can run in parallel.
PORT=$((20000 + $$ % 20000))
BUS="udpm://239.255.76.67:$PORT?ttl=0&recv_buf_size=4194304"

cleanup() {
  local pids
  pids=$(jobs -p)
  [ -z "$pids" ] || kill $pids 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$WORK"
}
trap cleanup EXIT

fail() { echo "FAIL: $*" >&2; exit 1; }
# drive OUT ARGS...: a run in lockstep on this test's bus.
drive() { local out=$1; shift; (cd "$SOURCE" && "$BUILD/bin/rover_launcher" run "$@" --out "$out" --bus "$BUS"); }
# default_for SECONDS FILE: the default scenario with this timeout in message time.
default_for() { sed "s#\.\./terrain#$SOURCE/config/terrain#; s/^timeout_s:.*/timeout_s: $1/" "$SOURCE/config/scenarios/default.yaml" >"$2"; }
# six_metres FILE: the first six metres of the flat scenario.
six_metres() {
  sed 's/^  x_m: .*/  x_m: [10.0, 12.0, 14.0, 16.0]/; s/^  y_m: .*/  y_m: [20.0, 20.0, 20.0, 20.0]/; /^ \{8\}/d' \
    "$SOURCE/config/scenarios/flat.yaml" >"$1"
}
# metric RUN_DIR KEY
metric() { jq -r ".$2" "$1/metrics.json"; }
