#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# Fails where a C++ source is not as clang-format writes it, or lacks its two SPDX lines. --fix formats.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t sources < <(git ls-files '*.hpp' '*.cpp')
if [ "${1:-}" = "--fix" ]; then
  clang-format -i "${sources[@]}"
  exit 0
fi
clang-format --dry-run --Werror "${sources[@]}"
mapfile -t licensed < <(git ls-files '*.hpp' '*.cpp' '*.py' '*.sh' '*.cmake' '*CMakeLists.txt' demo test .ci/run)
failed=0
for file in "${licensed[@]}"; do
  if ! head -n 5 "$file" | grep -q 'SPDX-License-Identifier: Apache-2.0'; then
    echo "$file: the SPDX-License-Identifier line is missing" >&2
    failed=1
  fi
done
echo "check_format: ${#sources[@]} sources"
exit $failed
