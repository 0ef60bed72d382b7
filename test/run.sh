#!/usr/bin/env bash
# Builds and runs all tests. Unit tests run under AddressSanitizer and UndefinedBehaviorSanitizer, those with threads also
# under ThreadSanitizer, in separate builds; then the parser fuzzer and the integration tests. `unit`: only the unit tests,
# without sanitizers; `sanitize`: only the tests under sanitizers; `arm64`: test/arm64.sh. Called by ./rover test.
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
    run_ctest build -LE unit
    ;;
  arm64) exec test/arm64.sh "${@:2}" ;;
  *) exit 2 ;;  # ./rover says why
esac
