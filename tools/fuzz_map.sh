#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# Reads damaged map files under the address and undefined-behaviour sanitizers: none may crash.
#   tools/fuzz_map.sh [FILES] [SEED]          default: 100000 files, seed 1
set -euo pipefail
cd "$(dirname "$0")/.."
files=${1:-100000}
seed=${2:-1}
cmake --preset asan >/dev/null
cmake --build --preset asan --target parkade_fuzz_map
time build/asan/parkade_fuzz_map "$files" "$seed"
