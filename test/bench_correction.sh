#!/usr/bin/env bash
# Runs the bench of the global correction and writes test/results/correction.md. Called by ./rover bench correction.
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
  echo "Simulated drives of 150 m over Gale crater's DTM (rock areas 2-12 %), each in a world of its own. Along each the"
  echo "elevation maps that mapping would build: what a NavCam sees from the rover (hidden ground, patches without texture,"
  echo "lost points and pictures), with stereo's, the attitude's and the odometry's errors. Local maps are 5 m apart. Each is"
  echo "looked for from poses that are off by 0-10 m in any direction and up to 10 deg of yaw, with a sigma of 4 m and 4 deg."
  echo
  echo "*Featured* is a local map whose relief lets expect, with the map's noise, a match within \`max_expected_sigma_cells\` and"
  echo "\`max_expected_sigma_deg\` of \`config/global_localization.yaml\`, in its weakest direction; lines, worlds and seeds of the bench were not used to set that file. An orbital map"
  echo "with local distortion shows the ground up to 0.9 m (0.3 m rms along each axis) from its true place, which no matcher can"
  echo "know: errors count against the place where the map shows the seen ground (a rigid motion fitted to its distortion);"
  echo "without distortion that is the truth. A row holds if nothing accepted is wrong by more than a cell, at least 90 % of"
  echo "the tries on featured maps are accepted, p95 is at most half a cell and 0.5 deg, and no try takes more than 0.3 s;"
  echo "for the others: if nothing is accepted. The rows with distortion are harder than what is demanded, and not judged."
  echo
  echo "$TABLE"
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
exit "$STATUS"
