#!/usr/bin/env bash
# Bad input gives one clear line that names the file and the key, exit status 2, and leaves nothing behind.
. "$(dirname "$0")/lib.sh"

# refused NAME PATTERN SCENARIO [ARGS...]
refused() {
  local name=$1 pattern=$2 scenario=$3
  shift 3
  local status=0
  timeout 60 "$BUILD/bin/rover_launcher" run "$scenario" --out "$WORK/out" --bus "$BUS" "$@" >"$WORK/said" 2>&1 || status=$?
  [ $status = 2 ] || fail "$name: exit status $status, said: $(cat "$WORK/said")"
  grep -qE "$pattern" "$WORK/said" || fail "$name: said: $(cat "$WORK/said")"
  rm -rf "$WORK/out"
}

cd "$SOURCE"
scenario() { sed "s#\.\./terrain#$SOURCE/config/terrain#" config/scenarios/default.yaml; }
dtm=$SOURCE/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif

refused "no scenario" "nowhere.yaml: no such file" "$WORK/nowhere.yaml"

scenario | sed "s#dtm: .*#dtm: $WORK/missing.tif#" >"$WORK/s.yaml"
refused "missing DTM" "missing.tif" "$WORK/s.yaml"

head -c 20000 "$dtm" >"$WORK/cut.tif"
scenario | sed "s#dtm: .*#dtm: $WORK/cut.tif#" >"$WORK/s.yaml"
refused "cut DTM" "cut.tif" "$WORK/s.yaml"

scenario | sed 's/x_m: \[/x_m: [999999.0, /; s/y_m: \[/y_m: [0.0, /' >"$WORK/s.yaml"
refused "path outside of the map" "s.yaml.*x_m" "$WORK/s.yaml"

scenario | sed 's/x_m: \[/x_m: [.nan, /; s/y_m: \[/y_m: [0.0, /' >"$WORK/s.yaml"
refused "NaN in the path" "s.yaml.*x_m" "$WORK/s.yaml"

scenario | sed 's/^seed: .*/seed: 1\nseeed: 2/' >"$WORK/s.yaml"
refused "unknown key" "s.yaml:[0-9]+: seeed: unknown key" "$WORK/s.yaml"

scenario | sed 's/^seed: .*/seed: fast/' >"$WORK/s.yaml"
refused "wrong type" "s.yaml:[0-9]+: seed: not a whole number" "$WORK/s.yaml"

refused "unknown file of --set" "nothing.yaml" config/scenarios/flat.yaml --set nothing.key=1
refused "unknown key of --set" "vehicle.yaml.*speed_kmh: unknown key" config/scenarios/flat.yaml --set vehicle.limits.speed_kmh=3
refused "value out of range" "vehicle.yaml.*radius_m: out of range" config/scenarios/flat.yaml --set vehicle.wheels.radius_m=-1

! pgrep -f "rover_simulator.*$PORT" >/dev/null || fail "a simulator is left"
echo "bad input is refused in one line"
