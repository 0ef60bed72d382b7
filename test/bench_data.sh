#!/usr/bin/env bash
# Drift on recorded and rendered stereo data sets: ./rover import, replay with the services in lockstep, report. Evaluates
# every data set below FOLDER in KITTI's odometry layout or EuRoC's; one that cannot be read is named with the reason. The
# logs are removed, the metrics kept. Writes test/results/data.md.
# Called by ./rover bench data [FOLDER]: default ROVER_DATA, or ../shared/data.
set -euo pipefail
DATA=${2:-${ROVER_DATA:-}}
[ -z "$DATA" ] || DATA=$(realpath -m "$DATA")  # relative to the user's folder
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
[ $# -le 2 ] || { echo "bench data: one folder is expected" >&2; exit 2; }
[ $# -lt 2 ] || [ -d "$DATA" ] || { echo "bench data: $2: no such folder" >&2; exit 2; }
DATA=${DATA:-$(realpath -m ../shared/data)}
OUT=test/results/data.md
LOGS=logs/bench/data
BUS="udpm://239.255.76.67:17790?ttl=0&recv_buf_size=4194304"
rm -rf "$LOGS"
mkdir -p test/results "$LOGS"
rows=
segments=
consistency=
unread=
found=

# judge NAME FOLDER
judge() {
  local run=$LOGS/${1//\//-} source name
  echo "$1" >&2
  if ! "$BUILD/bin/rover_import" "$2" --out "$run-log" >"$run.txt" 2>&1; then
    unread+="- $1: $(tail -1 "$run.txt" | sed "s#$DATA/##g")"$'\n'
    return
  fi
  if ! "$BUILD/bin/rover_launcher" replay "$run-log" --services stereo,visual_odometry,localization --speed max \
    --out "$run" --bus "$BUS" >>"$run.txt" 2>&1; then
    unread+="- $1: $(tail -1 "$run.txt")"$'\n'
    return
  fi
  "$BUILD/bin/rover_report" "$run" >>"$run.txt"
  rm -rf "$run-log" "$run"/*.lcm*
  if ! jq -e .truth "$run/metrics.json" >/dev/null; then
    unread+="- $1: has no ground truth"$'\n'
    return
  fi
  consistency+=$(jq -r --arg what "$1" '
    def r: (. * 100 | round) / 100;
    .vo_nees | select(. != null) |
    "| \($what) | \(.keyframes) | \(.translation | r) | \(.rotation | r) | \(.together | r) | \(.lower | r) to \(.upper | r) |"' \
    "$run/metrics.json")$'\n'
  for source in visual_odometry published_pose; do
    name=${source//_/ }
    rows+=$(jq -r --arg what "$1" --arg name "$name" --arg source $source '
      def r(n): if . == null then "-" else (. * pow(10; n) | round) / pow(10; n) end;
      .trajectory[$source] as $t | .trajectory.data_set_pairs as $pairs |
      (if ($t.length_m // 0) >= 1 then "**\($t.end_error_percent | r(2)) %**" else "-" end) as $percent |
      "| \($what) | \($name) | \($pairs) | \($pairs - .vo_frames - 1) | \(.vo_lost) | \($t.length_m | r(1)) m | \($percent) |" +
      " \($t.end_error_m | r(4)) m | \($t.ate_rmse_m | r(4)) m | \($t.rpe_rmse_m | r(4)) m, \($t.rpe_rmse_deg | r(3)) deg |"' \
      "$run/metrics.json")$'\n'
    segments+=$(jq -r --arg what "$1" --arg name "$name" --arg source $source '
      def r(n): (. * pow(10; n) | round) / pow(10; n);
      .trajectory[$source] as $t | [$t.segments[] | select(.count > 0)] | select(length > 0) |
      "| \($what) | \($name) | \(map("\(.length_m) m: \(.translation_percent | r(2)) %") | join(", ")) |" +
      " \($t.all_segments.translation_percent | r(2)) % | \($t.all_segments.rotation_deg_per_m | r(4)) deg/m |"' \
      "$run/metrics.json")$'\n'
  done
}

"$BUILD/test/tools/make_euroc_data_set" "$LOGS/rendered-set" 200
judge "rendered ground, EuRoC layout" "$LOGS/rendered-set"
rm -rf "$LOGS/rendered-set"
while read -r set; do
  name=${set#"$DATA"}
  name=${name#/}
  found=yes
  judge "${name:-$(basename "$DATA")}" "$set"
done < <(find -L "$DATA" -maxdepth 5 \( -name calib.txt -o -type d -name cam0 \) -printf '%h\n' 2>/dev/null | sed 's#/mav0$##' | sort -u)
[ $# -lt 2 ] || [ -n "$found" ] || { echo "bench data: $2: no data set in KITTI's odometry layout or EuRoC's below it" >&2; exit 2; }
{
  echo "# Drift on stereo data sets"
  echo
  echo "Command: \`./rover bench data FOLDER\`; commit $(git describe --always --dirty --abbrev=12)."
  echo
  echo "*Visual odometry*: its integrated motions. *Published pose*: \`POSE\` of localization at the exposure, before the pair was"
  echo "processed: it extrapolates with the last speed and is stationary until the first motion. Unaccounted: pairs,"
  echo "except the first, without a visual odometry message. The error after alignment is the rms for the best rigid motion"
  echo "(\`evo_ape -a\`); from pair to pair: rms of the relative pose error (\`evo_rpe\`)."
  echo
  echo "| data set | trajectory | pairs | unaccounted | lost | length | end error | | after alignment | from pair to pair |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
  printf '%s' "$rows"
  echo
  echo "KITTI metric: segments of 100 to 800 m from every tenth pair, as the development kit; below 100 m all segments of 10 to 50 m."
  echo
  echo "| data set | trajectory | segments | all | rotation |"
  echo "|---|---|---|---|---|"
  printf '%s' "$segments" | sed '/^$/d'
  echo
  echo "NEES of visual odometry: squared errors of the last alignment of each keyframe by the stated covariance, mean, per degree of"
  echo "freedom. 1 is consistent, more is overconfident; errors of calibration and of the truth count as well."
  echo
  echo "| data set | keyframes | translation | rotation | together | 95 % bounds |"
  echo "|---|---|---|---|---|---|"
  printf '%s' "$consistency" | sed '/^$/d'
  [ -z "$unread" ] || printf '\nNot read:\n\n%s' "$unread"
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
