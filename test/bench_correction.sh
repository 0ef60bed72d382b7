#!/usr/bin/env bash
# Benchmark of the global correction; writes test/results/correction.md. Called by ./rover bench correction.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/correction.md
mkdir -p test/results
cmake --build "$BUILD" --target correction_bench >&2
STATUS=0
TABLE=$("$BUILD/test/tools/correction_bench") || STATUS=$?
[ "$STATUS" -le 1 ] || exit "$STATUS"
{
  echo "# Global correction"
  echo
  echo "Command: \`./rover bench correction\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores, one used."
  echo
  echo "Simulated drives of 150 m over Gale crater's DTM (rock areas 2-12 %), each in its own world. Along each drive the"
  echo "elevation maps of the mapping are simulated: the view of a NavCam (occluded ground, patches without texture,"
  echo "lost points and images) with errors of stereo, attitude and odometry. Local maps are 5 m apart. Each is"
  echo "matched from poses with errors of 0-10 m in any direction and up to 10 deg of yaw, with a sigma of 4 m and 4 deg."
  echo
  echo "*Featured* is a local map whose relief is sufficient, given the map noise, for a match within \`max_expected_sigma_cells\` and"
  echo "\`max_expected_sigma_deg\` of \`config/global_localization.yaml\`, in its weakest direction; lines, worlds and seeds of the bench were not used to set that file. An orbital map"
  echo "with local distortion shows the ground up to 0.9 m (0.3 m rms along each axis) from its true place, which no matcher can"
  echo "know: errors are relative to the place where the map shows the observed ground (a rigid motion fitted to its distortion);"
  echo "without distortion that is the truth. A row is met if no accepted match is wrong by more than a cell, at least 90 % of"
  echo "the attempts on featured maps are accepted, p95 is at most half a cell and 0.5 deg, and no attempt takes more than 0.3 s;"
  echo "for the others: if no match is accepted. The rows with distortion are harder than required and not evaluated."
  echo
  echo "*Along one axis*: relief that is sufficient in its strongest direction only gives a fix along that axis, with an error measured"
  echo "along it. A place outside of the window can be inside along the axis, and is then right."
  echo "*NEES*: mean normalised error squared against the truth, per degree of freedom (x, y, yaw); 1 is consistent. The"
  echo "covariance includes the distortion of the map, which the other rows do not have."
  echo
  echo "The second table is of plains, 150 m each (rock areas 2-12 %, slope 1 deg, every second one of one soil alone), where relief gives no fix. The"
  echo "rover sees the brightness of the ground under its own sun (40 deg high in the north-west) with an exposure that varies by 5 %,"
  echo "the orbiter under a sun of 25 to 65 deg anywhere. A row is met if no accepted match shows another place (wrong by more than"
  echo "1 m), at least 80 % of the attempts are accepted, p95 is at most one pixel, and no attempt takes more than 0.3 s."
  echo
  echo "$TABLE"
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
exit "$STATUS"
