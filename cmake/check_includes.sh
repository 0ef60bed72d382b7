#!/usr/bin/env bash
# check_includes.sh SOURCE_DIR: no service includes another service's folder, and none a tool. Called by each build.
set -euo pipefail
cd "$1"
bad=$(grep -rHn --include=*.cpp --include=*.hpp '^#include "' services supervisor | awk -F: '
  { split($1, path, "/"); home = path[1] == "services" ? path[2] : path[1]
    split($3, quoted, "\""); split(quoted[2], used, "/")
    if (quoted[2] !~ "/" || (used[1] != home && used[1] != "common") || quoted[2] ~ "[.][.]/" || (home == "common" && used[1] != home))
      print $1 ":" $2 ": " home " may not include " quoted[2] }')
[ -z "$bad" ] || { echo "$bad" >&2; exit 1; }
