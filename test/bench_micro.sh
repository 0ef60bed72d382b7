#!/usr/bin/env bash
# Runs all micro benchmarks in sequence and writes test/results/micro.md. Called by ./rover bench micro.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
BUILD=$1
OUT=test/results/micro.md
mkdir -p test/results
{
  echo "# Micro benchmarks"
  echo
  echo "Command: \`./rover bench micro\`; commit $(git describe --always --dirty --abbrev=12); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores; one core each, median of 5 repetitions."
  echo
  echo "| benchmark | time | CPU |"
  echo "|---|---|---|"
} >$OUT.new
for program in "$BUILD"/bench/*; do
  [ -x "$program" ] && [ -f "$program" ] || continue
  "$program" --benchmark_repetitions=5 --benchmark_report_aggregates_only=true --benchmark_format=json 2>/dev/null |
    jq -r '.benchmarks[] | select(.aggregate_name == "median") |
      def figure(x): x * 1000 | round / 1000;
      "| \(.name | sub("_median$"; "")) | \(figure(.real_time)) \(.time_unit) | \(figure(.cpu_time)) \(.time_unit) |"' >>$OUT.new
done
mv $OUT.new $OUT
cat $OUT
