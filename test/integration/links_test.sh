#!/usr/bin/env bash
# Every relative link in every Markdown file leads to a file.
. "$(dirname "$0")/lib.sh"

cd "$SOURCE"
broken=0
while IFS=: read -r file link; do
  target=${link%%#*}
  [ -z "$target" ] || [ -e "$(dirname "$file")/$target" ] || { echo "$file: $link"; broken=1; }
done < <(find . -name '*.md' -not -path './build*' -not -path './logs/*' -print0 | xargs -0 grep -oHE '\]\([^)[:space:]]+\)' |
  sed -E 's/\]\(([^)]*)\)$/\1/' | grep -vE '^[^:]*:(https?|mailto):')
[ "$broken" = 0 ] || fail "these links lead nowhere"
echo "every relative link leads to a file"
