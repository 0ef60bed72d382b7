#!/usr/bin/env bash
# ./rover calibration: a file that the services read; bad input is one line, exit status 2, and nothing is overwritten.
. "$(dirname "$0")/../integration/lib.sh"
cd "$SOURCE"
calibration() { "$BUILD/bin/rover_calibration" "$@"; }
refused() {  # NAME PATTERN ARGS...
  local status=0
  calibration "${@:3}" >"$WORK/out" 2>"$WORK/said" || status=$?
  [ $status = 2 ] || fail "$1: exit status $status"
  [ "$(wc -l <"$WORK/said")" = 1 ] || fail "$1: not one line: $(cat "$WORK/said")"
  grep -q "$2" "$WORK/said" || fail "$1: said: $(cat "$WORK/said")"
}

camera() {
  cat <<TEXT
  camera_model: pinhole
  intrinsics: [417.5, 417.5, 257.3, 190.6]
  distortion_model: radtan
  distortion_coeffs: [-0.08, 0.04, 0.0004, -0.0003]
  resolution: [512, 384]
TEXT
}
{
  echo "cam0:"
  camera
  # The camera looks along the IMU's x axis, without pitch.
  echo "  T_cam_imu: [[0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, -0.5], [0, 0, 0, 1]]"
  echo "cam1:"
  camera
  echo "  T_cn_cnm1: [[1, 0, 0, -0.12], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"
} >"$WORK/camchain.yaml"

calibration "$WORK/camchain.yaml" --out "$WORK/cameras.yaml" || fail "a camchain was refused"
grep -q "position_m: \[0.120000, 0.000000, 0.000000\]" "$WORK/cameras.yaml" || fail "baseline: $(cat "$WORK/cameras.yaml")"
grep -q "pitch_down_deg: 33.0000" "$WORK/cameras.yaml" || fail "the mount was not kept: $(cat "$WORK/cameras.yaml")"
grep -q "^navcam:" "$WORK/cameras.yaml" || fail "the other camera is gone"

calibration "$WORK/camchain.yaml" --mount 0.4 0.06 0.1 20 1 -2 >"$WORK/mounted.yaml" || fail "--mount was refused"
grep -q "position_m: \[0.4000, 0.0600, 0.1000\], pitch_down_deg: 20.0000, roll_deg: 1.0000, yaw_deg: -2.0000" \
  "$WORK/mounted.yaml" || fail "mount: $(cat "$WORK/mounted.yaml")"

# The IMU of vehicle.yaml is 0.1 m over the body's origin; the camera 0.5 m ahead of the IMU.
calibration "$WORK/camchain.yaml" --imu-rpy 0 30 0 >"$WORK/by_imu.yaml" || fail "--imu-rpy was refused"
grep -q "position_m: \[0.4330, 0.0000, -0.1500\], pitch_down_deg: 30.0000" "$WORK/by_imu.yaml" ||
  fail "by the IMU: $(grep left_in_body "$WORK/by_imu.yaml")"

cp "$WORK/cameras.yaml" "$WORK/before.yaml"
refused "a file that exists" "already exists and is not replaced" "$WORK/camchain.yaml" --out "$WORK/cameras.yaml"
cmp "$WORK/cameras.yaml" "$WORK/before.yaml" || fail "a file was overwritten"
refused "no file" "none.yaml: no such file" "$WORK/none.yaml"
sed '/T_cam_imu/d' "$WORK/camchain.yaml" >"$WORK/no_imu.yaml"
refused "no IMU" "no T_cam_imu" "$WORK/no_imu.yaml" --imu-rpy 0 0 0
sed 's/417.5, 417.5/4175000, 417.5/' "$WORK/camchain.yaml" >"$WORK/far.yaml"
refused "out of range" "left camera: focal lengths of 4175000" "$WORK/far.yaml"
sed 's/-0.08, 0.04/-80, 0.04/' "$WORK/camchain.yaml" >"$WORK/bent.yaml"
refused "out of range" "the result is out of range: cameras.yaml.*distortion" "$WORK/bent.yaml"
# Options before and after the file, from another folder, by relative names.
mkdir "$WORK/elsewhere"
(cd "$WORK/elsewhere" && calibration --size 512 384 ../camchain.yaml --out mine.yaml) || fail "--size swallowed the file"
[ -s "$WORK/elsewhere/mine.yaml" ] || fail "a relative --out is elsewhere"
refused "a folder that is not there" "no such folder" "$WORK/camchain.yaml" --out "$WORK/nowhere/cameras.yaml"
sed 's/radtan/equidistant/' "$WORK/camchain.yaml" >"$WORK/fisheye.yaml"
calibration "$WORK/fisheye.yaml" | grep -q "distortion_model: equidistant" || fail "equidistant is not taken over"
echo "calibrations become cameras.yaml"
