#!/usr/bin/env bash
# arm64.sh PACKAGE...: builds everything for arm64 in build-arm64 and runs the unit tests under qemu's user emulation; then
# compares outputs of the cores on both processors and writes test/results/arm64.md. The -dev packages among PACKAGE are
# unpacked beside the build. Called by ./rover test arm64.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=build-arm64
OUT=test/results/arm64.md

# MuJoCo and Embree take more than ten minutes each under emulation. The others need a shell that knows the emulator, files
# of packages outside the sysroot, or the CPU time that /proc counts.
EXCLUDED=(simulator_node_test vehicle_test camera_test
  calibration_command_test orbital_planner_files_test mission_control_page_test status_io_test)

libraries=()
for package in "$@"; do case $package in *-dev) libraries+=("$package") ;; esac; done
cmake/arm64_sysroot.sh "$BUILD" "${libraries[@]}"
cmake -S . -B "$BUILD" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/arm64.cmake" >/dev/null
ninja -C "$BUILD" --quiet all unit_tests core_outputs
cmake -S . -B build -G Ninja >/dev/null
ninja -C build --quiet core_outputs

status=0
ctest --test-dir "$BUILD" --output-on-failure -j "$(nproc)" -L unit \
  -E "^($(IFS='|'; echo "${EXCLUDED[*]}"))\$" | tee "$BUILD/tests.txt" || status=$?

WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
mkdir "$WORK"/{here,arm64}
split_outputs() { awk -F, -v folder="$1" '{ print $2 >(folder "/" $1) }'; }
build/test/tools/core_outputs | split_outputs "$WORK/here"
qemu-aarch64 -L "$BUILD/sysroot" "$BUILD/test/tools/core_outputs" | split_outputs "$WORK/arm64"
{
  printf '# arm64 and %s\n\n' "$(uname -m)"
  printf 'Command: `./rover test arm64`; commit %s; %s, %s cores; arm64: %s, %s.\n\n' \
    "$(git describe --always --dirty --abbrev=12)" "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" \
    "$(nproc)" "$(aarch64-linux-gnu-g++ --version | head -1)" "$(qemu-aarch64 --version | head -1)"
  printf 'Unit tests under emulation: %s; left out: %s.\n\n' \
    "$(sed -n 's/\(.*\) tests passed, \(.*\)/\1 passed, \2/p' "$BUILD/tests.txt")" "${EXCLUDED[*]:-none}"
  printf '| output of a core | numbers | identical in every bit | largest difference |\n|---|---|---|---|\n'
  for file in "$WORK"/here/*; do
    paste -d' ' "$file" "$WORK/arm64/${file##*/}" | awk -v name="${file##*/}" '
      $1 == $2 { ++same; next }
      NF < 2 || ($1 == "nan") != ($2 == "nan") { incomparable = 1; next }
      { difference = $1 - $2; if (difference < 0) difference = -difference }
      difference > largest { largest = difference }
      END { printf "| %s | %d | %d | %s |\n", name, NR, same, incomparable ? "another number of values" : largest ? sprintf("%.1e", largest) : "0" }'
  done
} >"$OUT.new"
mv "$OUT.new" "$OUT"
cat "$OUT"
exit $status
