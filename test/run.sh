#!/usr/bin/env bash
# Builds and runs every test, those of the cores also under AddressSanitizer and UndefinedBehaviorSanitizer. `unit`: only
# the unit tests; `sanitize`: all unit tests under the sanitizers, in a build of their own. Called by ./rover test.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

JOBS=$(nproc)
run_ctest() { ctest --test-dir "$1" --output-on-failure -j "$JOBS" "${@:2}"; }

configure_and_build() {
  cmake -S . -B "$1" -G Ninja "${@:3}" >/dev/null
  ninja -C "$1" --quiet "$2"
}

sanitized() {  # TARGET LABEL
  configure_and_build build-sanitize "$1" -DROVER_SANITIZE=ON
  run_ctest build-sanitize -L "$2"
}

case "${1:-all}" in
  sanitize) sanitized unit_tests unit ;;
  unit)
    configure_and_build build unit_tests
    run_ctest build -L unit
    ;;
  all)
    configure_and_build build all
    sanitized core_tests core
    run_ctest build
    ;;
  *)
    echo "rover test: '$1' is not a part of the tests; there are: unit, sanitize" >&2
    exit 2
    ;;
esac
