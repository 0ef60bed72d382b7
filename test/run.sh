#!/usr/bin/env bash
# Builds and runs every test. `unit`: only the unit tests; `sanitize`: the unit tests under AddressSanitizer and
# UndefinedBehaviorSanitizer. Called by ./rover test.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

JOBS=$(nproc)
run_ctest() { ctest --test-dir "$1" --output-on-failure -j "$JOBS" "${@:2}"; }

configure_and_build() {
  cmake -S . -B "$1" -G Ninja "${@:3}" >/dev/null
  ninja -C "$1" --quiet "$2"
}

# The sanitized build has the unit tests alone, in a folder of its own.
if [ "${1:-}" = sanitize ]; then
  configure_and_build build-sanitize unit_tests -DROVER_SANITIZE=ON
  run_ctest build-sanitize -L unit
  exit
fi
configure_and_build build all
if [ "${1:-}" = unit ]; then
  run_ctest build -L unit
else
  run_ctest build
fi
