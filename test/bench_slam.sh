#!/usr/bin/env bash
# SLAM drift on simulated drives, registration of the clouds of the GA SLAM authors, update times. Writes
# test/results/slam.md. Missing clouds are reported and skipped.
# Called by ./rover bench slam with the build folder.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/slam.md
STUDY="$BUILD/test/tools/slam_study"
DATA=${ROVER_DATA:-../shared/data}
mkdir -p test/results
cmake --build "$BUILD" --target slam_study slam_bench >&2
{
  echo "# SLAM"
  echo
  echo "Command: \`./rover bench slam\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores."
  echo
  echo "## Drift over 100 m of featured terrain"
  echo
  echo "Gale crater's floor with rocks of k = 8 %, a NavCam cloud every 0.5 m with 0.25 px of noise and occlusions behind rocks; odometry by a"
  echo "model (scale, noise of each frame, gyro). Degraded: more noise, and a fifth of the frames replaced by slipping wheel odometry. Final"
  echo "horizontal error over the distance. Required: median at most 0.5 %, at most 10 % above odometry's, lower in 9 of 10 degraded drives."
  echo
  "$STUDY" drift
  echo
  echo "## Flat ground"
  echo
  echo "A plane without rocks. Required: at most 10 % above odometry's."
  echo
  "$STUDY" drift --flat
  echo
  echo "## NavCam with a calibration error of 0.1 px"
  echo
  "$STUDY" drift --disparity-offset-px 0.1 --last 4
  echo
  echo "## Recorded clouds"
  echo
  echo "31 rover clouds of the GA SLAM authors (Teide), without poses. Each is registered to up to four neighbours with the largest overlap,"
  echo "from 20 initial poses within 1 m and 5 deg; shown is the first neighbour with convergence, else the best. Convergence: all 20 results within 0.5 m of each other. Required: 80 % of the clouds with relief"
  echo "(at least 0.1 m rms about their plane)."
  echo
  "$STUDY" teide "$DATA/ga_slam_teide/cloud_sequence" || true
  echo
  echo "## Time"
  echo
  echo "Required: 30 ms for a map update, 60 ms for a filter update, on one core."
  echo
  echo "| benchmark | CPU |"
  echo "|---|---|"
  "$BUILD/bench/slam_bench" --benchmark_repetitions=5 --benchmark_report_aggregates_only=true --benchmark_format=json 2>/dev/null |
    jq -r '.benchmarks[] | select(.aggregate_name == "median") | "| \(.name | sub("_median$"; "")) | \(.cpu_time * 100 | round / 100) \(.time_unit) |"'
} >$OUT.new
mv $OUT.new $OUT
cat $OUT
