#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# What ./demo does once the program is built: drives a car through the simulated garage, localises it
# from its six cameras and its IMU, and judges the result against the truth. Usage: tools/demo.sh OUT
# DEMO_SECONDS=N sets how long the drive is (default 45).
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:?usage: tools/demo.sh OUT}
seconds=${DEMO_SECONDS:-45}
parkade=build/release/parkade
mkdir -p "$out"

say() { printf '\n== %s\n' "$*"; }

say "1/4  A car with six cameras drives $seconds s through the garage 'paper' (route test1)"
"$parkade" sim --garage paper --route test1 --duration "$seconds" --fast --out "$out/sequence" --force
"$parkade" sim --garage paper --route test1 --preview "$out/route.png"

say "2/4  What was recorded"
"$parkade" info "$out/sequence"

say "3/4  Parkade localises the car: key points of six cameras and the IMU"
"$parkade" run "$out/sequence" --method vis --final --force --out "$out/run"

say "4/4  Judged against the truth (first pose anchored)"
"$parkade" eval "$out/run" "$out/sequence" --align origin --json "$out/eval.json" --plot "$out/trajectory.svg"

say "Results are in $out"
cat <<EOF
  $out/route.png          the garage from above and the route
  $out/sequence/          the recording: images, IMU, wheels, truth
  $out/run/               trajectory.tum, health.csv, timing.json, config.yaml
  $out/trajectory.svg     estimate and truth, error over time: open it in a browser
  $out/eval.json          the figures of the table above
EOF
