#!/usr/bin/env bash
# Builds and runs every test; the unit tests also under AddressSanitizer and UndefinedBehaviorSanitizer, and those of them
# that start threads under ThreadSanitizer, in builds of their own; and the parsers of users' files on wrong ones. `unit`:
# only the unit tests; `sanitize`: only what runs under the sanitizers. Called by ./rover test.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

JOBS=$(nproc)
run_ctest() { ctest --test-dir "$1" --output-on-failure -j "$JOBS" "${@:2}"; }

configure_and_build() {
  cmake -S . -B "$1" -G Ninja "${@:3}" >/dev/null
  ninja -C "$1" --quiet "$2"
}

sanitized() {  # SANITIZER TARGET LABEL
  configure_and_build "build-$1" "$2" -DROVER_SANITIZE="$1"
  run_ctest "build-$1" -L "$3"
}
all_sanitized() {
  sanitized address unit_tests unit
  sanitized address fuzz_parsers fuzz
  sanitized thread thread_tests threads
}

case "${1:-all}" in
  sanitize) all_sanitized ;;
  unit)
    configure_and_build build unit_tests
    run_ctest build -L unit
    ;;
  all)
    configure_and_build build all
    all_sanitized
    run_ctest build
    ;;
  *)
    echo "rover test: '$1' is not a part of the tests; there are: unit, sanitize" >&2
    exit 2
    ;;
esac
