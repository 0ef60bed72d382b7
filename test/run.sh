#!/usr/bin/env bash
# Builds and runs every test. `unit`: only the unit tests; `sanitize`: those of the cores under AddressSanitizer and
# UndefinedBehaviorSanitizer, in a build of their own. Called by ./rover test.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

JOBS=$(nproc)
# The services whose cores decide over the rover; what only draws, records or starts things is left out.
CORES="rover_simulator;stereo;visual_odometry;localization;hazard_detector;path_planner;trajectory_control;locomotion"
run_ctest() { ctest --test-dir "$1" --output-on-failure -j "$JOBS" "${@:2}"; }

configure_and_build() {
  cmake -S . -B "$1" -G Ninja "${@:3}" >/dev/null
  ninja -C "$1" --quiet "$2"
}

sanitized() {
  configure_and_build build-sanitize unit_tests -DROVER_SANITIZE=ON -DROVER_SERVICES="$CORES"
  run_ctest build-sanitize -L unit
}

case "${1:-all}" in
  sanitize) sanitized ;;
  unit)
    configure_and_build build unit_tests
    run_ctest build -L unit
    ;;
  all)
    configure_and_build build all
    run_ctest build
    ;;
  *)
    echo "rover test: '$1' is not a part of the tests; there are: unit, sanitize" >&2
    exit 2
    ;;
esac
