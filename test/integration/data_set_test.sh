#!/usr/bin/env bash
# Stereo data sets through ./rover import, replay and report: a rendered one in EuRoC layout with distorted images, and,
# if available, the recorded one in KITTI layout. Every pair is accounted for.
. "$(dirname "$0")/lib.sh"
. "$SOURCE/test/wild.sh"
cd "$SOURCE"

# judged NAME DATA_SET: imports, replays with the services, makes the report; metrics in $WORK/NAME/metrics.json.
judged() {
  "$BUILD/bin/rover_import" "$2" --out "$WORK/$1-log/" >"$WORK/out" || fail "$1: import: $(cat "$WORK/out")"
  cp "$WORK/out" "$WORK/$1.said"
  "$BUILD/bin/rover_launcher" replay "$WORK/$1-log" --services stereo,visual_odometry,localization --speed max \
    --out "$WORK/$1" --bus "$BUS" >"$WORK/out" 2>&1 || fail "$1: replay: $(cat "$WORK/out")"
  "$BUILD/bin/rover_report" "$WORK/$1" >/dev/null || fail "$1: report"
  local pairs truth
  truth=$(sed -n 's/.* \([0-9]*\) with ground truth$/\1/p' "$WORK/$1.said")
  pairs=$(metric "$1" trajectory.data_set_pairs)
  [ "$(metric "$1" vo_frames)" = $((pairs - 1)) ] || fail "$1: $(metric "$1" vo_frames) motions between $pairs pairs"
  [ "$(metric "$1" vo_lost)" = 0 ] || fail "$1: $(metric "$1" vo_lost) motions lost"
  for source in visual_odometry published_pose; do
    [ "$(metric "$1" trajectory.$source.poses)" = "$truth" ] || fail "$1: $source has not every pose"
    jq -e ".trajectory.$source.end_error_percent < 1.0" "$WORK/$1/metrics.json" >/dev/null ||
      fail "$1: $source ends $(metric "$1" trajectory.$source.end_error_percent) % off"
  done
  jq -e '.trajectory.visual_odometry.segments[0] | .count > 0 and .translation_percent < 3' "$WORK/$1/metrics.json" \
    >/dev/null || fail "$1: stretches: $(metric "$1" trajectory.visual_odometry.segments)"
  grep -q "Comparison with the ground truth" "$WORK/$1/report.html" || fail "$1: the report has no comparison with the truth"
  echo "$1: $pairs pairs, end error $(metric "$1" trajectory.visual_odometry.end_error_percent) %"
}
metric() { jq -r ".$2" "$WORK/$1/metrics.json"; }

"$BUILD/test/tools/make_euroc_data_set" "$WORK/euroc" 110
judged rendered "$WORK/euroc"

# The truth begins later and ends earlier than the images, as in V1_01 and MH_01.
cp -r "$WORK/euroc" "$WORK/cut_set"
rows=$WORK/cut_set/mav0/state_groundtruth_estimate0/data.csv
sed -i '2,9d' "$rows"
head -n -10 "$rows" >"$WORK/rows"
mv "$WORK/rows" "$rows"
judged cut "$WORK/cut_set"
grep -q "skipped: 8 pairs before the ground truth begins" "$WORK/cut.said" || fail "cut: $(cat "$WORK/cut.said")"
wild_row "Data sets" "EuRoC: a rendered drive whose truth begins eight pairs late and ends ten early" "27 % and 35 % of error" \
  "$(metric cut trajectory.visual_odometry.end_error_percent) %, whole $(metric rendered trajectory.visual_odometry.end_error_percent) %"

"$BUILD/test/tools/make_euroc_data_set" "$WORK/fisheye_set" 110 equidistant
judged fisheye "$WORK/fisheye_set"
wild_row "Data sets" "EuRoC: a rendered drive with equidistant (fisheye) lenses" "refused" \
  "$(metric fisheye trajectory.visual_odometry.end_error_percent) %"

data=${ROVER_DATA:-$SOURCE/../shared/data}
if [ -d "$data/kitti_06_0_50" ]; then
  judged kitti "$data/kitti_06_0_50"
else
  echo "skipped: $data/kitti_06_0_50 does not exist (51 pairs of KITTI's sequence 06; its licence keeps it out of this project)"
fi
if [ -d "$data/euroc_v101_rest" ]; then
  "$BUILD/bin/rover_import" "$data/euroc_v101_rest" --out "$WORK/v101" >"$WORK/said" || fail "V1_01: $(cat "$WORK/said")"
  grep -q "^EuRoC: 19 stereo pairs of 752 x 480 px, 19 with ground truth" "$WORK/said" &&
    grep -q "skipped: 21 pairs before" "$WORK/said" || fail "V1_01: $(cat "$WORK/said")"
  wild_row "Data sets" "EuRoC V1_01, the first 40 pairs; truth begins after 1.04 s" "21 pairs at the pose of another" \
    "$(grep "skipped" "$WORK/said")"
else
  echo "skipped: $data/euroc_v101_rest does not exist (40 pairs of EuRoC's V1_01)"
fi

echo "-- bad input"
code=0
"$BUILD/bin/rover_import" "$WORK/none" --out "$WORK/new" 2>"$WORK/said" || code=$?
[ $code = 2 ] && [ "$(wc -l <"$WORK/said")" = 1 ] && [ ! -e "$WORK/new" ] || fail "no folder: $code $(cat "$WORK/said")"
code=0
"$BUILD/bin/rover_import" "$WORK/euroc" --out "$WORK/rendered" 2>"$WORK/said" || code=$?
[ $code = 2 ] && grep -q "already exists and is not empty" "$WORK/said" && [ -s "$WORK/rendered/metrics.json" ] || fail "overwritten: $code"

echo "-- interrupted"
for signal in INT TERM KILL; do
  "$BUILD/bin/rover_import" "$WORK/euroc" --out "$WORK/broken" >"$WORK/out" 2>"$WORK/said" &
  import=$!
  until [ -s "$WORK/broken/.unfinished/traverse.lcm" ] || ! kill -0 $import 2>/dev/null; do sleep 0.005; done
  kill -$signal $import 2>/dev/null || true
  code=0
  wait $import || code=$?
  if [ $code = 0 ]; then
    rm -r "$WORK/broken"  # the import was faster
    continue
  fi
  [ $signal = KILL ] && continue
  [ $code = 1 ] && [ "$(wc -l <"$WORK/said")" = 1 ] && [ ! -e "$WORK/broken" ] ||
    fail "SIG$signal: status $code: $(cat "$WORK/said"; ls -a "$WORK/broken" 2>&1)"
  wild_row "Interruption" "import, SIG$signal" ".unfinished stays, and no other try is taken" "$(sed "s#$WORK/##" "$WORK/said")"
done
"$BUILD/bin/rover_import" "$WORK/euroc" --out "$WORK/broken/" >"$WORK/out" || fail "second import: $(cat "$WORK/out")"
wild_row "Interruption" "import again after SIGKILL, and --out DIR/" "'cannot be made', for ever" "$(sed -n 's#imported: .*/#imported: #p' "$WORK/out")"

echo "-- full disk"
code=0
(trap '' XFSZ; ulimit -f 2000; "$BUILD/bin/rover_import" "$WORK/euroc" --out "$WORK/full") >"$WORK/out" 2>"$WORK/said" || code=$?
[ $code = 2 ] && [ "$(wc -l <"$WORK/said")" = 1 ] && [ ! -e "$WORK/full" ] || fail "full disk: $code $(cat "$WORK/said")"
wild_row "Disk full" "import" "one line; or a log without its end" "$(sed "s#$WORK/##g" "$WORK/said")"
echo "data sets are imported and replayed"
