#!/usr/bin/env bash
# Stereo data sets of other projects through ./rover import, replay and report: a rendered one in EuRoC's layout with raw,
# distorted pictures, and, where it is there, the recorded one in KITTI's layout. Every pair is accounted for.
. "$(dirname "$0")/lib.sh"
cd "$SOURCE"

# judged NAME DATA_SET: imports, replays with the services, judges; the figures are $WORK/NAME/metrics.json.
judged() {
  "$BUILD/bin/rover_import" "$2" --out "$WORK/$1-log" >"$WORK/out" || fail "$1: import: $(cat "$WORK/out")"
  "$BUILD/bin/rover_launcher" replay "$WORK/$1-log" --services stereo,visual_odometry,localization --speed max \
    --out "$WORK/$1" --bus "$BUS" >"$WORK/out" 2>&1 || fail "$1: replay: $(cat "$WORK/out")"
  "$BUILD/bin/rover_report" "$WORK/$1" >/dev/null || fail "$1: report"
  local pairs
  pairs=$(metric "$1" trajectory.data_set_pairs)
  [ "$(metric "$1" vo_frames)" = $((pairs - 1)) ] || fail "$1: $(metric "$1" vo_frames) motions between $pairs pairs"
  [ "$(metric "$1" vo_lost)" = 0 ] || fail "$1: $(metric "$1" vo_lost) motions lost"
  for source in visual_odometry published_pose; do
    [ "$(metric "$1" trajectory.$source.poses)" = "$pairs" ] || fail "$1: $source has not every pose"
    jq -e ".trajectory.$source.end_error_percent < 1.0" "$WORK/$1/metrics.json" >/dev/null ||
      fail "$1: $source ends $(metric "$1" trajectory.$source.end_error_percent) % off"
  done
  jq -e '.trajectory.visual_odometry.segments[0] | .count > 0 and .translation_percent < 3' "$WORK/$1/metrics.json" \
    >/dev/null || fail "$1: stretches: $(metric "$1" trajectory.visual_odometry.segments)"
  grep -q "Against the ground truth" "$WORK/$1/report.html" || fail "$1: the report says nothing of it"
  echo "$1: $pairs pairs, end error $(metric "$1" trajectory.visual_odometry.end_error_percent) %"
}
metric() { jq -r ".$2" "$WORK/$1/metrics.json"; }

"$BUILD/test/tools/make_euroc_data_set" "$WORK/euroc" 110
judged rendered "$WORK/euroc"

data=${ROVER_DATA:-$SOURCE/../shared/data}/kitti_06_0_50
if [ -d "$data" ]; then
  judged kitti "$data"
else
  echo "skipped: $data is not there (51 pairs of KITTI's sequence 06; its licence keeps it out of this project)"
fi

echo "-- bad input"
code=0
"$BUILD/bin/rover_import" "$WORK/none" --out "$WORK/new" 2>"$WORK/said" || code=$?
[ $code = 2 ] && [ "$(wc -l <"$WORK/said")" = 1 ] && [ ! -e "$WORK/new" ] || fail "no folder: $code $(cat "$WORK/said")"
code=0
"$BUILD/bin/rover_import" "$WORK/euroc" --out "$WORK/rendered" 2>"$WORK/said" || code=$?
[ $code = 2 ] && grep -q "exists already" "$WORK/said" && [ -s "$WORK/rendered/metrics.json" ] || fail "overwritten: $code"
echo "data sets of others go through the services"
