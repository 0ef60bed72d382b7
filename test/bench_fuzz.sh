#!/usr/bin/env bash
# Feeds mutated files to each parser of user files, under sanitizers; writes test/results/fuzz.md.
# Called by ./rover bench fuzz [--seconds N].
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
SECONDS_EACH=600
if [ "${1:-}" = --seconds ]; then
  SECONDS_EACH=${2:-}
  shift 2 || true
fi
[[ $SECONDS_EACH =~ ^[1-9][0-9]{0,5}$ ]] || { echo "bench fuzz: --seconds: '$SECONDS_EACH' is not a whole number from 1 to 999999" >&2; exit 2; }
[ $# -eq 0 ] || { echo "bench fuzz: unknown argument '$1'; see ./rover bench --help" >&2; exit 2; }

cmake -S . -B build-address -G Ninja -DROVER_SANITIZE=address >/dev/null
ninja -C build-address --quiet fuzz_parsers
PROGRAM=$PWD/build-address/test/fuzz/fuzz_parsers
FINDINGS=$PWD/build-address/fuzz_findings
ROWS=$(mktemp -d)
trap 'rm -rf "$ROWS"' EXIT
OUT=test/results/fuzz.md
status=0
"$PROGRAM" --list | xargs -P "$(nproc)" -I {} sh -c \
  '"$0" "$1" --seconds "$2" --seed "$3" --findings "$4" >"$5/$1"' \
  "$PROGRAM" {} "$SECONDS_EACH" "$(date +%s)" "$FINDINGS" "$ROWS" || status=1
{
  printf '# Mutated files for each parser\n\n'
  printf '`./rover bench fuzz --seconds %s`, commit %s; %s, %s cores; under AddressSanitizer and\n' "$SECONDS_EACH" \
    "$(git describe --always --dirty --abbrev=12)" "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" "$(nproc)"
  printf 'UndefinedBehaviorSanitizer. Each input is a valid file with one to six changes ([test/fuzz](../fuzz/README.md)).\n'
  printf 'A finding is a crash, more than 10 s of CPU time, more than 1 GB, a refusal that is not one line, any other\n'
  printf 'exception, or an overwritten input.\n\n'
  printf '| parser | inputs | refused | s | corpus | maximum memory | slowest input (its number) | findings |\n'
  printf '|---|---|---|---|---|---|---|---|\n'
  "$PROGRAM" --list | while read -r parser; do cat "$ROWS/$parser"; done
} >"$OUT.new"
mv "$OUT.new" "$OUT"
cat "$OUT"
exit $status
