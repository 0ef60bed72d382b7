#!/usr/bin/env bash
# Cores use no middleware, YAML, clock or global random numbers; GNC services use neither TRUTH nor the simulated world.
. "$(dirname "$0")/lib.sh"

for core in $(find "$BUILD" -name 'lib*_core.a'); do
  bad=$(nm -C --undefined-only "$core" 2>/dev/null |
    grep -E ' (lcm_|lcm::|YAML::|std::chrono::_V2::(system|steady)_clock::now|time$|clock_gettime|gettimeofday|rand$|srand|cv::theRNG|printf|puts$|std::cout|std::random_device)' || true)
  [ -z "$bad" ] || fail "$(basename "$core") uses: $bad"
done

for service in supervisor $(cd "$SOURCE/services" && ls -- */main.cpp | cut -d/ -f1 | grep -vxE 'rover_simulator|recorder'); do
  program=$BUILD/bin/$service
  [ -x "$program" ] || fail "$service is not built"
  nm -C "$program" >"$WORK/symbols"
  strings "$program" >"$WORK/strings"
  ! grep -qE 'rover::(World|RockField|VehicleSim|TileScene)::' "$WORK/symbols" || fail "$service links the simulated world"
  # mission_control's page can show the true world, but its node never receives it (telemetry_subscriber_test).
  [ "$service" = mission_control ] || ! grep -qx TRUTH "$WORK/strings" || fail "$service names the channel TRUTH"
done
# Maps are read by common/geo, which does not use the simulator.
for program in rover_orbital_planner rover_export; do
  nm -C "$BUILD/bin/$program" >"$WORK/symbols"
  ! grep -qE 'rover::(World|RockField)::' "$WORK/symbols" || fail "$program links the simulated world"
done
# Maps made from the true surface are for benches.
links_truth() { nm -C "$1" >"$WORK/symbols" 2>/dev/null && grep -q 'rover::truth::' "$WORK/symbols"; }
links_truth "$BUILD/bin/rover_one_process" || fail "rover_one_process has no truth_perception: the next check finds nothing"
for program in "$BUILD"/bin/*; do
  [ "$(basename "$program")" != rover_one_process ] || continue
  ! links_truth "$program" || fail "$(basename "$program") links truth_perception"
done
bad=$(cd "$SOURCE" && grep -rl '#include "rover_simulator/world/' services supervisor |
  grep -vE '^services/(rover_simulator)/' || true)
[ -z "$bad" ] || fail "these use the simulated world: $bad"
echo "cores and services are separated"
