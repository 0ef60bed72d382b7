#!/usr/bin/env bash
# Behaviour of unusual user files and requests, before and now, as tested: test/results/wild.md.
# Called by ./rover bench wild.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/wild.md
ROWS=$BUILD/wild_rows.tsv
rm -f "$ROWS"
ROVER_WILD_ROWS=$ROWS ctest --test-dir "$BUILD" -L wild -j "$(nproc)" --output-on-failure
{
  printf '# Files and requests from the wild\n\n'
  printf '`./rover bench wild`, commit %s. Each row is a test that has passed; "before" is commit 7fdcfb3, where it was\n' \
    "$(git describe --always --dirty --abbrev=12)"
  printf 'tried or its code read. Rows: %s.\n' "$(wc -l <"$ROWS")"
  sort -s -t $'\t' -k1,1 "$ROWS" | awk -F '\t' '
    $1 != kind { kind = $1; printf "\n## %s\n\n| input | before | now |\n|---|---|---|\n", kind }
    { printf "| %s | %s | %s |\n", $2, $3, $4 }'
} >"$OUT.new"
mv "$OUT.new" "$OUT"
printf '%s: %s rows\n' "$OUT" "$(wc -l <"$ROWS")"
