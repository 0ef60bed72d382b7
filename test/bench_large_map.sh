#!/usr/bin/env bash
# A map of 10 km2 at 0.25 m: a plan across it, what it costs `drive` at its start, and a lost rover on one of 2.6 km2.
# Writes test/results/large_map.md. Called by ./rover bench large_map.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/large_map.md
GALE=config/terrain/gale/gale_hirise_dtm_1m_348x337.tif
mkdir -p test/results
cmake --build "$BUILD" --target make_large_map lost_bench >&2
WORK=$(mktemp -d -t rover-large-map-XXXXXX)
trap 'rm -rf "$WORK"' EXIT
"$BUILD/test/tools/make_large_map" "$GALE" 3162.5 0.25 "$WORK/map.tif"

# Seconds and MB of a program.
measured() {
  /usr/bin/python3 -c '
import resource, subprocess, sys, time
start = time.monotonic()
status = subprocess.call(sys.argv[1:], stdout=sys.stderr)
print(f"{time.monotonic() - start:.1f} {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.0f}")
sys.exit(status)' "$@"
}

pid_of() { s6-svstat -o pid "$1" 2>/dev/null || echo -1; }

# Seconds until every service is up, and MB of all of them 3 s later.
started() { # NAME MAP
  local dir=$WORK/$1 bus='udpm://239.255.76.67:7691?ttl=0&recv_buf_size=4194304' launcher driver begin now service pid kb=0
  "$BUILD/bin/example_driver" --bus "$bus" >&2 &
  driver=$!
  begin=$(date +%s.%N)
  "$BUILD/bin/rover_launcher" drive --ground examples/driver/ground.yaml --map "$2" --headless --level efficient \
    --out "$dir" --bus "$bus" >&2 &
  launcher=$!
  for service in localization path_planner supervisor mission_control; do
    until [ "$(pid_of "$dir/services/$service")" -gt 0 ]; do
      kill -0 "$launcher" || { kill "$driver"; return 1; }
      sleep 0.05
    done
  done
  now=$(date +%s.%N)
  sleep 3
  for service in "$dir"/services/*; do
    pid=$(pid_of "$service")
    [ "$pid" -lt 0 ] || kb=$((kb + $(awk '/^VmRSS/ { print $2 }' "/proc/$pid/status")))
  done
  kill "$launcher" "$driver"
  wait "$launcher" "$driver" || true
  awk -v from="$begin" -v to="$now" -v kb="$kb" 'BEGIN { printf "%.1f %.0f\n", to - from, kb / 1024 }'
}

read -r PLAN_S PLAN_MB < <(measured "$BUILD/bin/rover_orbital_planner" "$WORK/map.tif" --start 300,300 --goal 2800,2800 --out "$WORK/plan")
read -r SMALL_S SMALL_MB < <(started small "$GALE")
read -r LARGE_S LARGE_MB < <(started large "$WORK/map.tif")
STATUS=0
LOST=$("$BUILD/test/tools/lost_bench") || STATUS=$?
[ "$STATUS" -le 1 ] || exit "$STATUS"
{
  echo "# Large maps, and a lost rover"
  echo
  echo "Command: \`./rover bench large_map\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  echo "A map of 12,650 x 12,650 pixels of 0.25 m (10 km²): Gale crater's relief stretched, its slopes kept, and its detail on top."
  echo
  echo "| | measured | demanded |"
  echo "|---|---|---|"
  echo "| plan across it, $(jq '[.features[] | select(.geometry.type == "LineString") | .properties.length_m] | add | round' "$WORK/plan/path.geojson") m | $PLAN_S s, $PLAN_MB MB | 60 s, 1,000 MB |"
  echo "| start of \`drive\` until all services are up | $LARGE_S s ($SMALL_S s with a map of 348 x 337 pixels) | 1 s more |"
  echo "| memory of all services 3 s later | $LARGE_MB MB ($SMALL_MB MB) | 100 MB more |"
  echo
  echo "## A lost rover"
  echo
  echo "Ten simulated drives of 100 m over 1.6 x 1.6 km of the same kind of terrain with rocks; orbital maps with 0.1 m of noise. Each local"
  echo "map is searched for from a pose that is up to 480 m off and says so (a sigma of 167 m), with up to 10 deg of yaw."
  echo
  echo "$LOST"
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
exit "$STATUS"
