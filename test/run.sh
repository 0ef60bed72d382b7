#!/usr/bin/env bash
# Builds and runs the tests: first the unit tests under AddressSanitizer and UndefinedBehaviorSanitizer, then every
# test of the normal build. `unit`: only the unit tests of the normal build. Called by ./rover test.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

JOBS=$(nproc)
run_ctest() { ctest --test-dir "$1" --output-on-failure -j "$JOBS" "${@:2}"; }

configure_and_build() {
  cmake -S . -B "$1" -G Ninja "${@:3}" >/dev/null
  ninja -C "$1" --quiet "$2"
}

configure_and_build build all
if [ "${1:-}" = unit ]; then
  run_ctest build -L unit
  exit
fi
configure_and_build build-sanitize unit_tests -DROVER_SANITIZE=ON
run_ctest build-sanitize -L unit
run_ctest build
