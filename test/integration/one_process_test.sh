#!/usr/bin/env bash
# Services in one process: the same run as in processes of their own, the same twice, and what it refuses.
. "$(dirname "$0")/lib.sh"

six_metres "$WORK/flat.yaml"
messages_of() {  # RUN: all messages but those that state time and process
  "$BUILD/bin/rover_export" "$1" --format csv --out "$1/csv" >/dev/null
  (cd "$1/csv/csv" && rm -f HEARTBEAT.csv && sha256sum ./*.csv)
}

for run in a b; do
  drive "$WORK/$run" "$WORK/flat.yaml" --perception geometric --headless >"$WORK/$run.txt" || fail "run $run: $(cat "$WORK/$run.txt")"
done
[ "$(metric "$WORK/a" perception)" = geometric ] || fail "metrics.json does not name the tier"
[ ! -e "$WORK/a/csv/csv/LOCCAM_LEFT.csv" ] || fail "there are images"
diff <(messages_of "$WORK/a") <(messages_of "$WORK/b") >&2 || fail "two runs differ"

drive "$WORK/truth" "$WORK/flat.yaml" --perception truth --headless >/dev/null || fail "truth"
[ "$(metric "$WORK/truth" perception)" = truth ] || fail "metrics.json does not name the tier truth"

# Composition: rendered images in one process give the messages of a run in processes.
drive "$WORK/processes" "$WORK/flat.yaml" --headless >/dev/null
cp -r "$WORK/processes/config" "$WORK/config"
mkdir -p "$WORK/one/service_logs"
"$BUILD/bin/rover_one_process" --config "$WORK/config" --scenario "$WORK/config/scenario.yaml" --run-dir "$WORK/one" \
  --perception rendered >/dev/null
cp -r "$WORK/config" "$WORK/one/config"
diff <(messages_of "$WORK/processes" | grep -E ' \./(TRUTH|POSE|HAZARDS|PATH|WHEEL_COMMAND|STATE)') \
  <(messages_of "$WORK/one" | grep -E ' \./(TRUTH|POSE|HAZARDS|PATH|WHEEL_COMMAND|STATE)') >&2 || fail "another run than in processes"

refuses() {  # WHAT ARGS...
  local what=$1
  shift
  if drive "$WORK/refused" "$@" --perception geometric --headless >/dev/null 2>"$WORK/error"; then fail "accepted: $*"; fi
  grep -q -- "$what" "$WORK/error" && [ "$(wc -l <"$WORK/error")" = 1 ] || fail "not one line on $what: $(cat "$WORK/error")"
  [ ! -e "$WORK/refused" ] || fail "a run folder is left"
}
printf 'faults:\n  - {at_s: 5, fault: imu_dead}\n' | cat "$WORK/flat.yaml" - >"$WORK/faults.yaml"
refuses 'has faults, which need' "$WORK/faults.yaml"
refuses 'not with --realtime' "$WORK/flat.yaml" --realtime
refuses 'not with --allow-injection' "$WORK/flat.yaml" --allow-injection
