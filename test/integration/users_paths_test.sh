#!/usr/bin/env bash
# Paths are relative to the user's folder, may contain any characters, and may precede or follow options. No shell ever
# interprets text of the user.
. "$(dirname "$0")/lib.sh"
. "$SOURCE/test/wild.sh"

rover=$SOURCE/rover
home="$WORK/it's \$(touch BAD) ü"
mkdir "$home"
cd "$home"
sed "s#\(^  dtm: \).*#\1$SOURCE/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif#" "$SOURCE/config/scenarios/default.yaml" >dtm.yaml
six_metres mine.yaml
logs_before=$(ls "$SOURCE/logs")
on_bus=(--headless --bus "$BUS")

# --set before the scenario, a trailing slash after the folder.
"$rover" run --set path_planner.search.horizon_m=7 mine.yaml "${on_bus[@]}" --out "out; touch BAD; '/" >said 2>&1 ||
  fail "run: $(cat said)"
out="$home/out; touch BAD; '"
[ -s "$out/report.html" ] || fail "no report: $(cat said)"
grep -qF "report: $out/report.html" said || fail "run does not print the path of the report: $(cat said)"
wild_row "Names and shells" "run --out \"y'; touch BAD; '/\"" "the command in the name was run" "$(tail -1 said | sed "s#$WORK##")"
wild_row "Options" "run --set a.b=1 SCENARIO.yaml" "'--set SCENARIO.yaml: file.key=value is expected'" "$(tail -2 said | head -1)"
[ -z "$(find "$WORK" -name BAD -not -path "$home")" ] || fail "a name was run: $(find "$WORK" -name BAD)"

# Every command with relative paths, with and without a trailing slash.
cd "$home"
"$rover" report "$(basename "$out")/" >said || fail "report: $(cat said)"
"$rover" report "$(basename "$out")" "./$(basename "$out")" --out both.html >said || fail "comparison: $(cat said)"
[ -s both.html ] || fail "the comparison is elsewhere: $(cat said)"
"$rover" spy "$(basename "$out")/traverse.lcm" >said || fail "spy: $(cat said)"
"$rover" export "$(basename "$out")" --format tum --out tables/ >said || fail "export: $(cat said)"
[ -s tables/tum/estimate.txt ] || fail "the export is elsewhere: $(cat said)"
"$rover" replay "$(basename "$out")" --until 3 --speed max --bus "$BUS" >said 2>&1 || fail "replay: $(cat said)"
cp "$(basename "$out")/traverse.lcm" log.lcm
printf x >>log.lcm
"$rover" repair log.lcm >said || fail "repair: $(cat said)"
[ -s log.repaired.lcm ] || fail "the repaired log is elsewhere: $(cat said)"
ln -s "$SOURCE/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif" map.tif
"$rover" plan map.tif --start 96,262 --via 100,250 --goal 118,255 --out plan/ >said || fail "plan: $(cat said)"
[ -s plan/path.yaml ] || fail "the plan is elsewhere: $(cat said)"
wild_row "Paths" "relative names from a folder other than the checkout: run, report, spy, export, replay, repair, plan" \
  "not found, or results in the checkout" "all found, all results in that folder"
[ "$(ls "$SOURCE/logs")" = "$logs_before" ] || fail "something was left in the checkout's logs"

# Outputs never replace existing files.
kept() { # NAME FILE COMMAND...
  local name=$1 file=$2 before status=0
  shift 2
  before=$(sha256sum <"$file")
  "$@" >said 2>&1 || status=$?
  [ $status = 2 ] && [ "$(wc -l <said)" = 1 ] || fail "$name: status $status: $(cat said)"
  [ "$before" = "$(sha256sum <"$file")" ] || fail "$name: $file has changed"
  wild_row "Outputs" "$name" "replaced" "$(sed "s#$WORK/[^:]*/##" said)"
}
echo mine >plan/notes.txt
kept "plan --out of an earlier plan with the user's notes in it" plan/notes.txt "$rover" plan map.tif --start 96,262 --goal 118,255 --out plan
mkdir maps
cp map.tif maps/terrain.tif
kept "plan X/terrain.tif --out X" maps/terrain.tif "$rover" plan maps/terrain.tif --start 96,262 --goal 118,255 --out maps
ln -s maps link
kept "the same through a symbolic link" maps/terrain.tif "$rover" plan maps/terrain.tif --start 96,262 --goal 118,255 --out link/
mkdir foreign
cp log.repaired.lcm foreign/traverse.lcm
echo mine >foreign/report.html
kept "report of a folder with a report.html of the user's" foreign/report.html "$rover" report foreign
cp log.lcm photo.lcm
kept "repair --out its own input" photo.lcm "$rover" repair photo.lcm --out photo.lcm
kept "export --out its input's folder" foreign/traverse.lcm "$rover" export foreign --out foreign
ln -s "$home/foreign/report.html" both2.html
kept "a comparison through a link to a file of the user's" foreign/report.html \
  "$rover" report "$(basename "$out")" "$(basename "$out")" --out both2.html

# A tilde that the shell does not expand.
HOME=$home "$rover" report '--out=~/both3.html' "$(basename "$out")" "$(basename "$out")" >said || fail "tilde: $(cat said)"
[ -s both3.html ] || fail "no home folder: $(cat said)"
wild_row "Paths" "--out=~/NAME" "a folder called ~" "the home folder"

# Names that are not valid UTF-8.
cp mine.yaml $'caf\xe9.yaml'
"$rover" run $'caf\xe9.yaml' "${on_bus[@]}" --set rover=1 >said 2>&1 && fail "an unknown file of --set is accepted"
"$rover" run $'caf\xe9.yaml' "${on_bus[@]}" --out $'out\xe9' >said 2>&1 || fail "invalid UTF-8: $(cat said)"
[ -s $'out\xe9/report.html' ] || fail "no report for invalid UTF-8: $(cat said)"
wild_row "Paths" "a scenario and a folder whose names are Latin-1, not UTF-8" "terminated by an exception" "$(tail -2 said | head -1)"
[ -z "$(find "$WORK" -name BAD -not -path "$home")" ] || fail "a name was run: $(find "$WORK" -name BAD)"
echo "all paths are relative to the user's folder"
