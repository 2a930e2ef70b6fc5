#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# What ./demo does once the program is built: drives a car through the simulated garage, localises it
# live from its six cameras and its IMU, maps what it sees, and judges both by the truth.
# Usage: tools/demo.sh OUT
# DEMO_SECONDS=N sets how long the drive is (default 30).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd -P)
out=$(realpath -m --relative-base="$root" -- "${1:?usage: tools/demo.sh OUT}")
cd "$root"
seconds=${DEMO_SECONDS:-30}
parkade=build/release/parkade
mkdir -p "$out"

say() { printf '\n== %s\n' "$*"; }

say "1/3  The truth of the drive: $seconds s of route test1 through the garage 'paper', kept from the estimator"
"$parkade" sim --garage paper --route test1 --duration "$seconds" --no-images --out "$out/truth" --force
"$parkade" sim --garage paper --route test1 --preview "$out/route.png"

say "2/3  The drive, live: six cameras are drawn, and Parkade localises the car and maps the garage"
"$parkade" run "sim:paper/test1?fast=on&duration=$seconds" --method fused --force --out "$out/run"

say "3/3  Judged by the truth (first pose joined with it)"
"$parkade" eval "$out/run" "$out/truth" --align origin --json "$out/eval.json" --report "$out/report.html"
printf '\n'
"$parkade" eval map "$out/run" "$out/truth" --json "$out/map.json" --picture "$out/map_errors.png"

say "Results are in $out"
cat <<EOF
  $out/report.html        all of it on one page: open it in a browser
  $out/route.png          the garage from above and the route
  $out/run/               trajectory.tum, map.db, map/, health.csv, timing.json, config.yaml
  $out/map_errors.png     the map on the truth
  $out/eval.json          the figures of the tables above; map.json: the map's
EOF
