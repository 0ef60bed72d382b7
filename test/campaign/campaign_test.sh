#!/usr/bin/env bash
# Campaigns of fake drives on GNU parallel: kill and resume, drives that die, refusals, a full disk.
. "$(dirname "$0")/lib.sh"

campaign_file "$WORK/c.yaml" 1..12

# The rows of an uninterrupted campaign: each cell and seed once, one JSON object a line.
campaign "$WORK/c.yaml" --jobs 4 --out "$WORK/whole" >"$WORK/out"
grep -q '24 of 24 drives (100 %)' "$WORK/out" || fail "progress: $(cat "$WORK/out")"
[ "$(jq -r '[.cell.rock_area, .seed] | @csv' "$WORK/whole/rows.jsonl" | sort -u | wc -l)" = 24 ] || fail "rows are missing"
[ "$(wc -l <"$WORK/whole/rows.jsonl")" = 24 ] || fail "rows are doubled"
jq -es 'map(.["seconds.curve"] == .seed and .attempts == 1 and .status == "done" and .rock_area == .cell.rock_area) | all' \
  "$WORK/whole/rows.jsonl" >/dev/null || fail "a row: $(head -1 "$WORK/whole/rows.jsonl")"
# Failures keep their run folder: seeds 4, 8 and 12 of both cells.
[ "$(ls "$WORK/whole/runs" | wc -l)" = 6 ] || fail "kept: $(ls "$WORK/whole/runs")"
! ls -d "$WORK"/whole/work-* 2>/dev/null || fail "a session is left"

# Killed again and again, each time at another moment, then resumed: the same bytes.
echo 0.4 >"$FAKE_DRIVE/seconds"
for rows in 1 5 9 14 20; do
  begin "$WORK/c.yaml" --jobs 4 --out "$WORK/killed" --resume >/dev/null 2>&1
  wait_until "$rows rows" has_rows "$WORK/killed" $rows
  kill -9 $pid
  wait $pid 2>/dev/null || true
  wait_until "the drives of a killed campaign end" no_workers_in "$WORK/killed"
done
campaign "$WORK/c.yaml" --jobs 4 --out "$WORK/killed" --resume >/dev/null
cmp "$WORK/whole/rows.jsonl" "$WORK/killed/rows.jsonl" || fail "rows after kill and resume differ"
campaign "$WORK/c.yaml" --out "$WORK/killed" --resume | grep -q "complete" || fail "resume of a complete campaign"

# SIGTERM: one line, and the drives end.
begin "$WORK/c.yaml" --jobs 4 --out "$WORK/stopped" >/dev/null 2>"$WORK/stopped.said"
wait_until "3 rows" has_rows "$WORK/stopped" 3
refused 2 "two campaigns" "another campaign runs in this folder" "$WORK/c.yaml" --out "$WORK/stopped" --resume
kill -TERM $pid
status=0
wait $pid || status=$?
[ $status = 1 ] || fail "stopped: exit status $status"
said "stopped" "^$WORK/stopped: stopped; continue with --resume$" "$WORK/stopped.said"
wait_until "the drives of a stopped campaign end" no_workers_in "$WORK/stopped"
refused 2 "no --resume" "has a campaign; continue it with --resume" "$WORK/c.yaml" --out "$WORK/stopped"
mkdir "$WORK/other"
campaign_file "$WORK/other/c.yaml" 1..13
refused 2 "another file" "other/c.yaml: differs from $WORK/stopped/campaign.yaml" "$WORK/other/c.yaml" --out "$WORK/stopped" --resume
sed -i 's/"commit": "[^"]*"/"commit": "000000000000"/' "$WORK/stopped/campaign.json"
refused 2 "another commit" "was begun by commit 000000000000, this is " "$WORK/c.yaml" --out "$WORK/stopped" --resume

# A drive that dies is driven again; one that dies twice has a row that says so, and keeps its output.
echo 0.1 >"$FAKE_DRIVE/seconds"
touch "$FAKE_DRIVE/die-5" "$FAKE_DRIVE/die-once-7"
: >"$FAKE_DRIVE/starts"
campaign "$WORK/c.yaml" --jobs 4 --out "$WORK/died" >"$WORK/out"
grep -q "complete, 2 drives died" "$WORK/out" || fail "died drives are not reported: $(cat "$WORK/out")"
[ "$(jq -r 'select(.seed == 5) | [.status, .outcome, .attempts, .reason] | @csv' "$WORK/died/rows.jsonl" | sort -u)" = \
  '"died","",2,"exit status 2: path_planner: config/path_planner.yaml:3: out of range"' ] || fail "row of a died drive"
[ "$(jq -s 'map(select(.seed == 7 and .status == "done") | .attempts) | add' "$WORK/died/rows.jsonl")" = 3 ] || fail "retry"
[ "$(grep -c '^5 ' "$FAKE_DRIVE/starts")" = 4 ] || fail "a drive that dies is driven twice"
[ "$(ls "$WORK"/died/logs/job-*.log | wc -l)" = 2 ] || fail "output of died drives: $(ls "$WORK/died/logs")"
for log in "$WORK"/died/logs/job-*.log; do
  [ "$(stat -c %s "$log")" = 100000 ] || fail "the end of a large output is kept: $(stat -c %s "$log") bytes"
  [ "$(tail -1 "$log")" = "path_planner: config/path_planner.yaml:3: out of range" ] || fail "the end of $log: $(tail -1 "$log")"
  job=${log##*/job-}
  [ "$(cat "$WORK/died/runs/${job%.log}/service_logs/path_planner/current")" = began ] || fail "logs of a died drive"
done

# Drives that the engine begins once, and not again, have not died twice: here it loses one of the two that died.
mkdir "$WORK/loses"
cat >"$WORK/loses/parallel" <<SH
#!/bin/sh
for list; do case \$list in */parallel.jobs) [ "\$(wc -l <"\$list")" -gt 2 ] || sed -i 1d "\$list" ;; esac; done
exec $(command -v parallel) "\$@"
SH
chmod +x "$WORK/loses/parallel"
PATH=$WORK/loses:$PATH refused 1 "a drive that is not begun again" \
  "loses_one: parallel ended, and did not begin 1 drives; see .*; continue with --resume" \
  "$WORK/c.yaml" --jobs 4 --out "$WORK/loses_one"
[ "$(jq -r 'select(.status == "died")' "$WORK/loses_one/rows.jsonl")" = "" ] || fail "a drive that was begun once has died"
rm "$FAKE_DRIVE/die-5"

# Somebody builds another commit meanwhile.
echo 0123456789ab >"$FAKE_DRIVE/commit"
refused 1 "another build" "built: job [0-9]*: its drive is of commit 0123456789ab, the campaign of .*; continue with --resume" \
  "$WORK/c.yaml" --jobs 2 --out "$WORK/built"
[ ! -s "$WORK/built/rows.jsonl" ] || fail "rows of another commit"
rm "$FAKE_DRIVE/commit"

# A worker that is killed is a drive that died.
echo 2 >"$FAKE_DRIVE/seconds"
begin "$WORK/c.yaml" --jobs 24 --out "$WORK/worker" >/dev/null
wait_until "all drives run" eval '[ "$(workers_in "rover_campaign job --dir $WORK/worker.*--min-free [0-9]* 7$" | wc -l)" -ge 1 ]'
kill -9 $(workers_in "bin/rover_campaign job --dir $WORK/worker.*--min-free [0-9]* 7$")
wait $pid || fail "a killed worker ends the campaign"
[ "$(jq -s 'map(.attempts) | add' "$WORK/worker/rows.jsonl")" = 25 ] || fail "a killed worker's drive was not repeated"
[ "$(jq -cS 'del(.attempts)' "$WORK/worker/rows.jsonl" | sha256sum)" = "$(jq -cS 'del(.attempts)' "$WORK/whole/rows.jsonl" | sha256sum)" ] ||
  fail "rows after a killed worker differ"

# Bad input is one line, and makes no folder.
printf 'scenario: %s\nseeds: 1\naxes:\n  wind: 3\n' "$SOURCE/config/scenarios/flat.yaml" >"$WORK/bad.yaml"
refused 2 "unknown axis" "bad.yaml:4: axes.wind: unknown axis" "$WORK/bad.yaml" --out "$WORK/bad"
mkdir "$WORK/empty_path"
status=0
PATH=$WORK/empty_path "$BUILD/bin/rover_campaign" "$WORK/c.yaml" --out "$WORK/bad" 2>"$WORK/said" || status=$?
[ $status = 2 ] || fail "no engine: exit status $status"
said "no engine" "'parallel' is not installed; Debian has it in the package parallel"
refused 2 "ssh with slurm" "sshloginfile: GNU parallel's alone" "$WORK/c.yaml" --engine slurm --sshloginfile "$WORK/c.yaml"
refused 2 "no file" "a campaign file is required" --resume
[ ! -e "$WORK/bad" ] || fail "a refused campaign leaves a folder"
mkdir "$WORK/mine" && touch "$WORK/mine/thesis.tex"
refused 2 "folder of mine" "is not empty and has no campaign" "$WORK/c.yaml" --out "$WORK/mine"
! "$BUILD/bin/rover_campaign" --help | grep -q drive-program || fail "the fake drive is in the help"

# A full disk: one line, no row of what ran at that time; with space again the rest is driven.
if [ "$(id -u)" = 0 ] && mkdir "$WORK/disk" && mount -t tmpfs -o size=1040m tmpfs "$WORK/disk" 2>/dev/null; then
  trap 'umount -l "$WORK/disk"; cleanup' EXIT
  echo 0.2 >"$FAKE_DRIVE/seconds"
  begin "$WORK/c.yaml" --jobs 2 --out "$WORK/disk/c" >/dev/null 2>"$WORK/said"
  wait_until "4 rows" has_rows "$WORK/disk/c" 4
  echo 150M >"$FAKE_DRIVE/fill"
  status=0
  wait $pid || status=$?
  [ $status = 1 ] || fail "full disk: exit status $status"
  said "full disk" "$WORK/disk/c: disk full: 1.00 GB have to be free; continue with --resume"
  left=$(rows "$WORK/disk/c")
  [ "$left" -lt 24 ] || fail "the full disk came too late"
  rm "$FAKE_DRIVE/fill"
  # Small enough that the filler alone is too much.
  fallocate -l 150M "$WORK/disk/filler"
  refused 2 "start on a full disk" "disk full" "$WORK/c.yaml" --out "$WORK/disk/c" --resume
  rm "$WORK/disk/filler"
  campaign "$WORK/c.yaml" --jobs 4 --out "$WORK/disk/c" --resume >/dev/null
  cmp "$WORK/whole/rows.jsonl" "$WORK/disk/c/rows.jsonl" || fail "rows after a full disk differ"
fi
echo "campaigns: kill, resume, deaths and refusals are in order"
