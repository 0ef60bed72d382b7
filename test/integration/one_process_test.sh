#!/usr/bin/env bash
# Services in one process: the same run as in processes of their own, the same twice, and what it refuses.
. "$(dirname "$0")/lib.sh"

six_metres "$WORK/flat.yaml"
messages_of() {  # RUN: sums of all channels but HEARTBEAT, which states time and process, into RUN.sums
  "$BUILD/bin/rover_export" "$1" --format csv --out "$1/csv" >/dev/null || fail "no export of $1"
  (cd "$1/csv/csv" && rm -f HEARTBEAT.csv && sha256sum ./*.csv) >"$1.sums"
  for channel in TRUTH POSE HAZARDS PATH WHEEL_COMMAND STATE; do
    grep -q " ./$channel.csv" "$1.sums" || fail "$1 has no $channel"
  done
}
same() { diff "$WORK/$1.sums" "$WORK/$2.sums" >&2; }  # RUN RUN

for tier in geometric truth; do
  for run in a b; do
    drive "$WORK/$tier-$run" "$WORK/flat.yaml" --perception $tier --headless >"$WORK/said" || fail "$tier: $(cat "$WORK/said")"
    messages_of "$WORK/$tier-$run"
  done
  [ "$(metric "$WORK/$tier-a" perception)" = $tier ] || fail "metrics.json does not name the tier $tier"
  [ ! -e "$WORK/$tier-a/csv/csv/LOCCAM_LEFT.csv" ] || fail "there are images"
  same $tier-a $tier-b || fail "two runs of $tier differ"
done
# Composition: rendered images in one process give the messages of a run in processes.
drive "$WORK/processes" "$WORK/flat.yaml" --headless >/dev/null
cp -r "$WORK/processes/config" "$WORK/config"
mkdir -p "$WORK/one/service_logs"
"$BUILD/bin/rover_one_process" --config "$WORK/config" --scenario "$WORK/config/scenario.yaml" --run-dir "$WORK/one" \
  --perception rendered >/dev/null
cp -r "$WORK/config" "$WORK/one/config"
messages_of "$WORK/processes"
messages_of "$WORK/one"
# Whether the last tick is in the log depends on how soon the recorder ends.
for channel in TRUTH POSE HAZARDS PATH WHEEL_COMMAND STATE; do
  files=("$WORK"/{processes,one}/csv/csv/$channel.csv)
  lines=$(wc -l "${files[@]}" | awk '$2 != "total" && (least == "" || $1 < least) { least = $1 } END { print least - 1 }')
  cmp <(head -n "$lines" "${files[0]}") <(head -n "$lines" "${files[1]}") || fail "$channel: another run than in processes"
  [ $(($(cat "${files[@]}" | wc -l) - 2 * lines)) -le 6 ] || fail "$channel: a run is longer"
done

# A computer ten times slower: stereo takes 1.2 s for a pair, so each third of those every 0.4 s is used.
drive "$WORK/slow" "$WORK/flat.yaml" --perception geometric --headless --cpu-scale 10 >"$WORK/said" || fail "slow: $(cat "$WORK/said")"
messages_of "$WORK/slow"
frames() { awk -F, 'NR > 1' "$1/csv/csv/HAZARDS.csv" | wc -l; }
fast=$(frames "$WORK/geometric-a") slow=$(frames "$WORK/slow")
[ $((slow * 5)) -le $((fast * 2)) ] && [ $((slow * 4)) -ge "$fast" ] || fail "$slow frames of HAZARDS of $fast"

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
refuses 'cpu-scale' "$WORK/flat.yaml" --cpu-scale 0
refuses 'hazard_detector.yaml.*margin_m' "$WORK/flat.yaml" --set hazard_detector.limits.margin_m=-3

# A drive ends with the launcher.
default_for 3000 "$WORK/long.yaml"
drive "$WORK/stopped" "$WORK/long.yaml" --perception geometric --headless >/dev/null 2>&1 &
for _ in $(seq 100); do [ -s "$WORK/stopped/traverse.lcm" ] && break; sleep 0.1; done
pkill -TERM -f "rover_launcher run $WORK/long.yaml"
wait $! || true
! pgrep -f "run-dir $WORK/stopped" >/dev/null || fail "rover_one_process runs on"
[ "$(metric "$WORK/stopped" outcome)" = stopped ] || fail "no report of a stopped run"
