#!/usr/bin/env bash
# check_includes.sh SOURCE_DIR: no service includes another service's folder, and none a tool; only benches include what
# makes maps from the true world. Called by each build.
set -euo pipefail
cd "$1"
bad=$(grep -rHn --include=*.cpp --include=*.hpp '^#include "' services supervisor | awk -F: '
  { split($1, path, "/"); home = path[1] == "services" ? path[2] : path[1]
    split($3, quoted, "\""); split(quoted[2], used, "/")
    if (quoted[2] !~ "/" || (used[1] != home && used[1] != "common") || quoted[2] ~ "[.][.]/" || (home == "common" && used[1] != home))
      print $1 ":" $2 ": " home " may not include " quoted[2] }')
bad=$bad${bad:+$'\n'}$(grep -rHn --include=*.cpp --include=*.hpp '^#include "tools/truth_perception/' services supervisor tools examples |
  grep -vE '^tools/(truth_perception|one_process)/' | sed -E 's/^([^:]*:[0-9]+):#include "(.*)"$/\1: what is no bench may not include \2/' || true)
[ -z "$bad" ] || { echo "$bad" >&2; exit 1; }
