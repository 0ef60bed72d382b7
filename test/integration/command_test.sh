#!/usr/bin/env bash
# The script ./rover: help with an example for each command, completion, and one line with the remedy for each error.
. "$(dirname "$0")/lib.sh"

rover=$SOURCE/rover
commands=$("$rover" help | awk '/^\.\/rover /{print $2}')
[ "$(wc -w <<<"$commands")" -ge 13 ] || fail "too few commands: $commands"
for command in $commands; do
  "$rover" help "$command" >"$WORK/help"
  grep -q "Example: .*rover" "$WORK/help" || fail "help $command has no example: $(cat "$WORK/help")"
done
# Help never starts a command, whatever its other arguments.
for command in build jar test lcm-spy completion "bench speed" "bench faults --part stack"; do
  "$rover" $command --help >"$WORK/help"
  grep -q "Example: " "$WORK/help" || fail "$command --help: $(cat "$WORK/help")"
done
# The programs show the name of their command.
while read -r command program arguments; do
  "$BUILD/bin/$program" $arguments --help >"$WORK/help"
  grep -q "Example" "$WORK/help" || fail "$program $arguments --help has no example: $(cat "$WORK/help")"
  grep -q "Usage: ./rover $command" "$WORK/help" || fail "$program $arguments --help: $(cat "$WORK/help")"
done <<'PROGRAMS'
run rover_launcher run
status rover_launcher status
inject rover_launcher inject
spy rover_spy
report rover_report
repair rover_repair
plan rover_orbital_planner
campaign rover_campaign
PROGRAMS

# refused NAME PATTERN COMMAND...
refused() {
  local name=$1 pattern=$2 status=0
  shift 2
  "$@" >"$WORK/out" 2>"$WORK/said" || status=$?
  [ $status = 2 ] || fail "$name: exit status $status, said: $(cat "$WORK/said")"
  [ "$(wc -l <"$WORK/said")" = 1 ] || fail "$name: not one line: $(cat "$WORK/said")"
  grep -qE -- "$pattern" "$WORK/said" || fail "$name: said: $(cat "$WORK/said")"
  [ ! -s "$WORK/out" ] || fail "$name: prints: $(cat "$WORK/out")"
}
refused "no such command" "'rum' is not a command; there are: run " "$rover" rum
refused "help on nothing" "'rum' is not a command" "$rover" help rum
refused "an argument too many" "takes no 'all'" "$rover" build all
refused "a window without a display" "./rover spy shows the same" env -u DISPLAY "$rover" lcm-spy
for program in "rover_launcher run" "rover_launcher status" rover_spy rover_report rover_repair rover_orbital_planner rover_campaign; do
  refused "$program with an unknown option" "see ./rover .* --help" "$BUILD"/bin/$program --no-such-option
done
refused "spy on nothing" "$WORK/none.lcm: no such log" "$BUILD/bin/rover_spy" "$WORK/none.lcm"
refused "repair of nothing" "$WORK/none.lcm: no such log" "$BUILD/bin/rover_repair" "$WORK/none.lcm"
refused "report on nothing" "$WORK/none: no such folder" "$BUILD/bin/rover_report" "$WORK/none"
refused "comparison with nothing" "$WORK/none: no such folder" "$BUILD/bin/rover_report" "$WORK/none" "$WORK/none" --out "$WORK/c.html"
echo mine >"$WORK/mine.html"
refused "comparison over a file of mine" "already exists and is not a comparison" \
  "$BUILD/bin/rover_report" "$WORK/none" "$WORK/none" --out "$WORK/mine.html"
[ "$(cat "$WORK/mine.html")" = mine ] || fail "a file was overwritten"
[ ! -e "$WORK/c.html" ] || fail "a refused comparison leaves a file"

# completes EXPECTED WORDS...: the last word is being typed.
cd "$SOURCE"  # files are completed relative to the current folder
"$rover" completion >"$WORK/completion.bash"
. "$WORK/completion.bash"
completes() {
  local expected=$1
  shift
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  COMPREPLY=()
  _rover
  [[ " ${COMPREPLY[*]} " == *" $expected "* ]] || fail "'$*' is completed by '${COMPREPLY[*]}', not $expected"
}
completes repair ./rover rep
completes --realtime ./rover run --r
completes efficient ./rover run --level e
completes geometric ./rover run --perception g
completes config/scenarios/flat.yaml ./rover run config/scenarios/f
completes POSE ./rover spy --channel PO
completes restarts ./rover bench r
completes sanitize ./rover test ""
completes slurm ./rover campaign --engine s
completes compare ./rover campaign comp

# No terminal control codes in a file.
"$rover" --help >"$WORK/help"
! grep -q $'\033' "$WORK/help" || fail "colours in a file"
echo "help, completion and refusals are in order"
