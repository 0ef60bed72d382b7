#!/usr/bin/env bash
# Bad input: one line with file and key, exit status 2, no files left.
. "$(dirname "$0")/lib.sh"
. "$SOURCE/test/wild.sh"

# one_line NAME STATUS PATTERN FILE: the file contains one line, which matches.
one_line() {
  [ "$2" = 2 ] || fail "$1: exit status $2, said: $(cat "$4")"
  [ "$(wc -l <"$4")" = 1 ] || fail "$1: not one line: $(cat "$4")"
  grep -qE "$3" "$4" || fail "$1: said: $(cat "$4")"
}

# refused NAME PATTERN SCENARIO [ARGS...]
refused() {
  local name=$1 pattern=$2 scenario=$3
  shift 3
  local status=0
  timeout 60 "$BUILD/bin/rover_launcher" run "$scenario" --out "$WORK/out" --bus "$BUS" "$@" \
    >"$WORK/out.txt" 2>"$WORK/said" || status=$?
  one_line "$name" $status "$pattern" "$WORK/said"
  [ ! -e "$WORK/out" ] || fail "$name: leaves a run folder: $(ls "$WORK/out")"
}

cd "$SOURCE"
dtm=$SOURCE/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif
# scenario [SED...]: the default scenario with changes, as $WORK/s.yaml.
scenario() { sed "s#\.\./terrain#$SOURCE/config/terrain#" config/scenarios/default.yaml | sed "$@" >"$WORK/s.yaml"; }
# path X Y: the default scenario with another path.
path() {
  scenario '/^path:/,/corridor/{/corridor/!d}'
  sed -i "s/^  corridor/path:\n  x_m: [$1]\n  y_m: [$2]\n  corridor/" "$WORK/s.yaml"
}

refused "no scenario" "nowhere.yaml: no such file" "$WORK/nowhere.yaml"
refused "a folder as scenario" "$WORK: is a folder; a file is expected" "$WORK"
echo "path: [" >"$WORK/s.yaml"
refused "no YAML" "s.yaml:[0-9]+: not valid YAML" "$WORK/s.yaml"

scenario "s#dtm: .*#dtm: $WORK/missing.tif#"
refused "missing DTM" "s.yaml:[0-9]+: world.dtm: .*missing.tif not found" "$WORK/s.yaml"
scenario "s#dtm: .*#dtm: $WORK/cut.tif#"
for bytes in 0 100 20000 200000; do
  head -c $bytes "$dtm" >"$WORK/cut.tif"
  refused "DTM cut at $bytes" "cut.tif: " "$WORK/s.yaml"
done
{ printf 'P5 400 400 255\n'; head -c 160000 /dev/zero; } >"$WORK/plain.pgm"
scenario "s#dtm: .*#dtm: $WORK/plain.pgm#"
refused "DTM without georeference" "plain.pgm: has no georeference" "$WORK/s.yaml"
path "100, 400" "100, 100"
refused "DTM smaller than the path" "s.yaml:[0-9]+: path.x_m: point 2 lies outside of the elevation model" "$WORK/s.yaml"

path "96.0" "262.0"
refused "path of one point" "s.yaml:[0-9]+: path.x_m: a path requires at least two points" "$WORK/s.yaml"
path "" ""
refused "path without points" "s.yaml:[0-9]+: path.x_m: a path requires at least two points" "$WORK/s.yaml"
path "96.0, .nan" "262.0, 262.0"
refused "NaN in the path" "s.yaml:[0-9]+: path.x_m: not a number" "$WORK/s.yaml"
path "96.0, 99.0" "262.0, .inf"
refused "infinity in the path" "s.yaml:[0-9]+: path.y_m: not a number" "$WORK/s.yaml"
path "-5.0, 99.0" "262.0, 262.0"
refused "path outside of the map" "s.yaml:[0-9]+: path.x_m: point 1 lies outside" "$WORK/s.yaml"

scenario 's/^seed: .*/seed: 1\nseeed: 2/'
refused "unknown key" "s.yaml:[0-9]+: seeed: unknown key" "$WORK/s.yaml"
scenario 's/^seed: .*/seed: fast/'
refused "wrong type" "s.yaml:[0-9]+: seed: not a whole number" "$WORK/s.yaml"
scenario 's/elevation_deg: 40.0/elevation_rad: 0.7/'
refused "wrong unit in a key" "s.yaml:[0-9]+: sun.elevation_rad: unknown key" "$WORK/s.yaml"
scenario 's/goal_tolerance_m: .*/goal_tolerance_m: 50 cm/'
refused "unit in a value" "s.yaml:[0-9]+: path.goal_tolerance_m: not a number" "$WORK/s.yaml"

refused "unknown file of --set" "nothing.yaml" config/scenarios/flat.yaml --set nothing.key=1
refused "--set without a value" "key=value is expected" config/scenarios/flat.yaml --set vehicle
refused "unknown section of --set" "no section 'motors'" config/scenarios/flat.yaml --set vehicle.motors.count=1

# Values that only services read: the services exit, the launcher reports one error, and no folder is left.
refused "unknown key of --set" "config/vehicle.yaml with --set: limits.speed_kmh: unknown key" config/scenarios/flat.yaml \
  --set vehicle.limits.speed_kmh=3
refused "value out of range" "config/vehicle.yaml with --set: wheels.radius_m: out of range" config/scenarios/flat.yaml \
  --set vehicle.wheels.radius_m=-1
refused "wrong unit of one service" "path_planner: .*config/path_planner.yaml with --set: margin_cm: unknown key" \
  config/scenarios/flat.yaml --set path_planner.margin_cm=20
refused "unit in a value of one service" "supervisor: .*config/supervisor.yaml with --set: permit_validity_s: not a number" \
  config/scenarios/flat.yaml --set "supervisor.permit_validity_s=200 ms"

# A goal within its tolerance of the start, or inside the clear circle around it, is reached.
for x in 10.3 10.6; do
  sed "s/^  x_m: .*/  x_m: [10.0, $x]/; s/^  y_m: .*/  y_m: [20.0, 20.0]/; /^ \{8\}/d" config/scenarios/flat.yaml >"$WORK/near.yaml"
  drive "$WORK/near" "$WORK/near.yaml" --headless >"$WORK/out.txt" 2>"$WORK/said" || fail "goal at $x m: $(cat "$WORK/said")"
  [ "$(metric "$WORK/near" outcome)" = goal_reached ] || fail "goal at $x m: $(metric "$WORK/near" outcome)"
  wild_row "Goals" "run: start at 10 m, goal at $x m, tolerance 0.5 m" "reached" "$(metric "$WORK/near" outcome)"
  rm -r "$WORK/near"
done

mkdir "$WORK/out"
echo mine >"$WORK/out/notes.txt"
status=0
"$BUILD/bin/rover_launcher" run config/scenarios/flat.yaml --out "$WORK/out" --bus "$BUS" >/dev/null 2>"$WORK/said" || status=$?
one_line "run folder in use" $status "$WORK/out: already exists and is not empty" "$WORK/said"
[ "$(cat "$WORK/out/notes.txt")" = mine ] || fail "a folder in use was changed"

# The report of a run with a missing or damaged log or folder.
report_refused() {
  local status=0
  "$BUILD/bin/rover_report" "$2" >/dev/null 2>"$WORK/said" || status=$?
  one_line "$1" $status "$3" "$WORK/said"
}
run=$WORK/run
mkdir "$run"
report_refused "report on nothing" "$WORK/none" "$WORK/none: no such folder"
report_refused "report without log" "$run" "$run/traverse.lcm: no such log"
: >"$run/traverse.lcm"
report_refused "report on an empty log" "$run" "$run/traverse.lcm: is empty"
printf 'no log at all\n' >"$run/traverse.lcm"
report_refused "report on a foreign file" "$run" "$run/traverse.lcm: contains no messages"

! pgrep -f ":$PORT[?]" >/dev/null || fail "a process is still running: $(pgrep -af ":$PORT[?]")"
echo "bad input is refused in one line"
