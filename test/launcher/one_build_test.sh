#!/usr/bin/env bash
# The script ./rover with made-up tools: two commands after a change of the sources build once, one after the other.
. "$(dirname "$0")/../integration/lib.sh"

mkdir -p "$WORK"/{tools/launcher,build/bin,path}
cp "$SOURCE/rover" "$WORK/"
cp "$SOURCE/tools/launcher/completion.bash" "$WORK/tools/launcher/"
touch "$WORK/CMakeLists.txt" "$WORK/build/build.ninja"
mkdir "$WORK"/{cmake,lcmtypes,services,supervisor,examples}
tool() { printf '#!/bin/bash\n%s\n' "$2" >"$1" && chmod +x "$1"; }
tool "$WORK/path/dpkg-query" 'echo -n installed'
tool "$WORK/path/ninja" "echo begin \$3 >>$WORK/said; sleep 0.5; echo end \$3 >>$WORK/said"
tool "$WORK/path/sudo" true
tool "$WORK/path/sysctl" true
tool "$WORK/build/bin/rover_launcher" '[ "$1" != --needs-full-level ]'
tool "$WORK/build/bin/rover_orbital_planner" true
export PATH=$WORK/path:$PATH

"$WORK/rover" run 2>/dev/null &
"$WORK/rover" run 2>/dev/null &
"$WORK/rover" plan map.tif 2>/dev/null &
for job in 1 2 3; do wait %$job || fail "command $job"; done
[ "$(grep -c 'begin runtime' "$WORK/said")" = 1 ] || fail "built twice: $(cat "$WORK/said")"
[ -e "$WORK/build/.built-runtime" ] && [ ! -e "$WORK/build/.building" ] || fail "stamps: $(ls -A "$WORK/build")"
awk '{ running += $1 == "begin" ? 1 : -1; if (running > 1) exit 1 }' "$WORK/said" || fail "two builds at once: $(cat "$WORK/said")"

# Nothing that the command becomes holds the lock.
flock -n "$WORK/build/.lock" true || fail "the lock is left"
for bench in $("$WORK/rover" help bench | sed -n '1s/.*\[\(.*\)\]/\1/p' | tr '|' ' '); do
  "$WORK/rover" completion | grep "^_ROVER_BENCHES=.*[\" ]$bench[\" ]" >/dev/null || fail "no completion of bench $bench"
done
echo "commands build one after the other"
