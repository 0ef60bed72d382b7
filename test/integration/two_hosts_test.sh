#!/usr/bin/env bash
# Two hosts, as network namespaces with a virtual cable: the simulator in one, as the vehicle's driver; the stack in the
# other. TTL 1. The drive reaches its goal, and the clock offset is measured and within its limit.
#   two_hosts_test.sh [SCENARIO]      default: 6 m on a plane; config/scenarios/default.yaml takes ten minutes
. "$(dirname "$0")/lib.sh"
cd "$SOURCE"

VEHICLE=rv$$
STACK=rs$$
CABLE=v$$
remove_hosts() {
  ip netns del $VEHICLE 2>/dev/null || true
  ip netns del $STACK 2>/dev/null || true
}
# on HOST COMMAND...: replaces the shell. Not `ip netns exec` or `ip -n`, which mount another /sys: not every container
# permits that.
on() { exec nsenter --net="/run/netns/$1" "${@:2}"; }
trap 'cleanup; remove_hosts' EXIT
if ! ip netns add $VEHICLE 2>/dev/null || ! ip netns add $STACK 2>/dev/null || ! (on $STACK true) ||
  ! ip link add ${CABLE}a netns $VEHICLE type veth peer name ${CABLE}b netns $STACK 2>/dev/null; then
  echo "SKIPPED: network namespaces are not permitted here (run it as root)"
  exit 77
fi
join() {  # HOST DEVICE ADDRESS
  (on "$1" ip link set lo up)
  (on "$1" ip address add "$3/24" dev "$2")
  (on "$1" ip link set "$2" up)
  (on "$1" ip route add 224.0.0.0/4 dev "$2")
}
join $VEHICLE ${CABLE}a 10.77.0.1
join $STACK ${CABLE}b 10.77.0.2
BUS="udpm://239.255.76.67:$PORT?ttl=1&recv_buf_size=4194304"

# ground.yaml and orbital map of the scenario, as `./rover run` writes them.
SCENARIO=${1:-$WORK/plane.yaml}
[ $# -gt 0 ] || cat >"$SCENARIO" <<'TEXT'
seed: 1
world:
  plane: {width_m: 40.0, height_m: 40.0, slope_deg: 0.0, toward_deg: 0.0}
  rock_area_k: 0.0
  roughness_rms_m: 0.0
  soil: {everywhere: firm}
path: {x_m: [10.0, 16.0], y_m: [20.0, 20.0], corridor_half_width_m: 1.5, goal_tolerance_m: 0.5}
timeout_s: 200
TEXT
"$BUILD/bin/rover_launcher" run "$SCENARIO" --headless --out "$WORK/ground" --bus "udpm://239.255.76.67:$PORT?ttl=0&recv_buf_size=4194304" \
  >"$WORK/ground.txt" 2>&1 &
first=$!
until [ -s "$WORK/ground/config/ground.yaml" ] && [ -s "$WORK/ground/launch.json" ]; do
  kill -0 $first 2>/dev/null || fail "no ground.yaml: $(cat "$WORK/ground.txt")"
  sleep 0.1
done
cp "$WORK/ground/config/ground.yaml" "$WORK/ground/orbital_map.tif" "$WORK/"
kill -INT $first
wait $first || true

# Slower than real time, so that a loaded machine keeps up.
PACE=${ROVER_PACE:-0.4}
on $VEHICLE "$BUILD/bin/rover_simulator" --config config --scenario "$SCENARIO" --bus "$BUS" --realtime \
  --pace $PACE --seed "$(sed -n 's/^seed: *//p' "$SCENARIO")" >"$WORK/vehicle.txt" 2>&1 &
vehicle=$!
on $STACK "$BUILD/bin/rover_launcher" drive --headless --until-goal --ground "$WORK/ground.yaml" \
  --map "$WORK/orbital_map.tif" --out "$WORK/run" --bus "$BUS" --timeout 60 >"$WORK/drive.txt" 2>&1 &
drive=$!
until grep -q DRIVING "$WORK/drive.txt"; do
  kill -0 $drive 2>/dev/null || fail "the drive ended early: $(tail -5 "$WORK/drive.txt"); $(tail -3 "$WORK/vehicle.txt")"
  sleep 0.2
done
# From the stack's host during the drive: offset of the driver's clocks from TICK.
(on $STACK "$BUILD/bin/rover_conform" --bus "$BUS" --listen 5) >"$WORK/conform.txt" || true
grep "  clock  " "$WORK/conform.txt" || fail "no offset was measured: $(cat "$WORK/conform.txt")"
grep -q "^pass  clock  " "$WORK/conform.txt" || fail "clock offset too large: $(cat "$WORK/conform.txt")"
grep -q "^pass  seq  " "$WORK/conform.txt" || fail "messages were lost: $(cat "$WORK/conform.txt")"

status=0
wait $drive || status=$?
[ $status = 0 ] || fail "the drive ended with $status: $(tail -5 "$WORK/drive.txt")"
tail -2 "$WORK/drive.txt"
[ "$(metric "$WORK/run" outcome)" = goal_reached ] || fail "outcome: $(metric "$WORK/run" outcome)"
[ "$(metric "$WORK/run" collisions)" = 0 ] || fail "collisions: $(metric "$WORK/run" collisions)"
kill $vehicle 2>/dev/null || true
wait $vehicle || true

# With the default TTL of 0 no message reaches the other host.
LOCAL="udpm://239.255.76.67:$((PORT + 1))?ttl=0&recv_buf_size=4194304"
on $VEHICLE "$BUILD/bin/example_driver" --bus "$LOCAL" >/dev/null &
quiet=$!
status=0
(on $STACK "$BUILD/bin/rover_conform" --bus "$LOCAL" --listen 2) >/dev/null 2>"$WORK/said" || status=$?
[ $status = 2 ] || fail "a bus of TTL 0 crosses the cable: $(cat "$WORK/said")"
kill $quiet
wait $quiet || true
echo "the drive on two hosts succeeds"
