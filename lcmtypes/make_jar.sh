#!/usr/bin/env bash
# Builds the jar of every message type, so that lcm-spy decodes every channel:
#   lcmtypes/make_jar.sh build/rover_types.jar && CLASSPATH=build/rover_types.jar lcm-spy
set -euo pipefail
OUT=$(readlink -m "${1:?usage: make_jar.sh OUT.jar}")
cd "$(dirname "$(readlink -f "$0")")"
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
lcm-gen --java --jpath "$WORK/source" ./*.lcm
mkdir "$WORK/classes"
javac -nowarn -d "$WORK/classes" -cp /usr/share/java/lcm.jar "$WORK"/source/rover/*.java
mkdir -p "$(dirname "$OUT")"
jar cf "$OUT" -C "$WORK/classes" .
