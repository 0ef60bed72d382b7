#!/usr/bin/env bash
# Drift on recorded and rendered stereo data sets: ./rover import, replay with the services in lockstep, report. Writes
# test/results/data.md. Missing data sets are reported and skipped.
# Called by ./rover bench data.
set -euo pipefail
[ -z "${ROVER_DATA:-}" ] || ROVER_DATA=$(realpath -m "$ROVER_DATA")  # relative to the user's folder
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/data.md
LOGS=logs/bench/data
DATA=${ROVER_DATA:-../shared/data}
BUS="udpm://239.255.76.67:17790?ttl=0&recv_buf_size=4194304"
rm -rf "$LOGS"
mkdir -p test/results "$LOGS"
rows=
stretches=
skipped=

# judge NAME WHAT FOLDER
judge() {
  "$BUILD/bin/rover_import" "$3" --out "$LOGS/$1-log"
  "$BUILD/bin/rover_launcher" replay "$LOGS/$1-log" --services stereo,visual_odometry,localization --speed max \
    --out "$LOGS/$1" --bus "$BUS"
  "$BUILD/bin/rover_report" "$LOGS/$1" >/dev/null
  local source name
  for source in visual_odometry published_pose; do
    name=${source//_/ }
    rows+=$(jq -r --arg what "$2" --arg name "$name" --arg source $source '.trajectory[$source] as $t | .trajectory.data_set_pairs as $pairs |
      "| \($what) | \($name) | \($pairs) | \($pairs - .vo_frames - 1) | \(.vo_lost) | \($t.length_m * 10 | round / 10) m | **\($t.end_error_percent * 100 | round / 100) %** | \($t.ate_rmse_m * 1000 | round / 1000) m |"' \
      "$LOGS/$1/metrics.json")$'\n'
    stretches+=$(jq -r --arg what "$2" --arg name "$name" --arg source $source '.trajectory[$source] as $t |
      def shown: if . == null then "-" else "\(. * 100 | round / 100) %" end;
      "| \($what) | \($name) | " + ([$t.segments[].translation_percent | shown] | join(" | ")) + " | \($t.all_segments.translation_percent | shown) | \($t.all_segments.rotation_deg_per_m * 10000 | round / 10000) deg/m |"' \
      "$LOGS/$1/metrics.json")$'\n'
  done
}

"$BUILD/test/tools/make_euroc_data_set" "$LOGS/euroc" 200
judge rendered "rendered ground, EuRoC layout, raw pictures 512 x 384" "$LOGS/euroc"
if [ -d "$DATA/kitti_06_0_50" ]; then
  judge kitti "KITTI 06, pairs 0-50, a car at 12 m/s, 1226 x 370" "$DATA/kitti_06_0_50"
else
  skipped="KITTI 06 is skipped: $DATA/kitti_06_0_50 does not exist."
  echo "skipped: $skipped" >&2
fi
{
  echo "# Drift on stereo data sets"
  echo
  echo "Command: \`./rover bench data\`; commit $(git describe --always --dirty --abbrev=12)."
  [ -z "$skipped" ] || printf '\n%s\n' "$skipped"
  echo
  echo "Requirement: end error at most 1.0 %, every pair accounted for. *Visual odometry*: its integrated motions. *Published"
  echo "pose*: \`POSE\` of localization at the exposure, before the pair was processed: it extrapolates 0.24 s with the last speed and is stationary until the first motion."
  echo "Unaccounted: pairs, except the first, without a visual odometry message. The error after alignment is the rms for the"
  echo "best rigid motion."
  echo
  echo "| data set | trajectory | pairs | unaccounted | lost | length | end error | error after alignment |"
  echo "|---|---|---|---|---|---|---|---|"
  printf '%s' "$rows"
  echo
  echo "KITTI metric, over all segments of each length:"
  echo
  echo "| data set | trajectory | 10 m | 20 m | 30 m | 40 m | 50 m | all | rotation |"
  echo "|---|---|---|---|---|---|---|---|---|"
  printf '%s' "$stretches"
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
