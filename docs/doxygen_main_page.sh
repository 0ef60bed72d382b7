#!/usr/bin/env bash
# doxygen_main_page.sh FILE: prints FILE and a table of all folders with the first sentence of their READMEs. Called by
# Doxygen in the project's folder.
set -euo pipefail

folders() {  # FOLDER...
  printf '| folder | purpose |\n|---|---|\n'
  local folder
  for folder in "$@"; do
    [ -e "$folder/README.md" ] || continue
    awk -v folder="$folder" '
      /^[A-Za-z`]/ { text = text " " $0; next }
      text != "" { exit }
      END {
        while (match(text, /\[[^]]*\]\([^)]*\)/)) {  # links become their text
          label = substr(text, RSTART + 1, index(substr(text, RSTART), "](") - 2)
          text = substr(text, 1, RSTART - 1) label substr(text, RSTART + RLENGTH)
        }
        gsub(/[|]/, "/", text)
        if (match(text, /[a-z`)][.] /)) text = substr(text, 1, RSTART + 1)
        printf "| \\ref %s |%s |\n", folder, text
      }' "$folder/README.md"
  done
}

cat "$1"
printf '\n## Services and supervisor\n\n'
folders services/* supervisor
printf '\n## Tools\n\n'
folders tools/*
