#!/usr/bin/env bash
# words_test.sh SOURCE_DIR: no file contains a word of test/words.txt, except measured tables.
set -euo pipefail
cd "$1"
patterns=$(grep -v '^#' test/words.txt | cut -f1)
search() { grep -rnIE --exclude-dir={results,data,terrain} --exclude=words.txt --exclude=words_test.sh -f <(printf '%s\n' "$patterns") "$@"; }
probe=$(mktemp)
trap 'rm -f "$probe"' EXIT
echo "// The rover stands still on its way back." >"$probe"
search "$probe" >/dev/null || { echo "words_test: finds nothing in a sentence of forbidden words" >&2; exit 1; }
if found=$(search README.md cmake config docs examples lcmtypes rover services supervisor templates test tools CMakeLists.txt); then
  printf 'words_test: write instead what test/words.txt says:\n%s\n' "$found" >&2
  exit 1
fi
