#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# Fails where a C++ source is not as clang-format writes it, or lacks its two SPDX lines. --fix formats.
set -euo pipefail
cd "$(dirname "$0")/.."
# A list from git that is empty, or that git fails to give, would pass without a look.
list() {
  local files
  files=$(git ls-files -- "$@") && [ -n "$files" ] && printf '%s\n' "$files" && return
  echo "check_format: git lists no files here" >&2
  return 1
}
cpp=$(list '*.hpp' '*.cpp')
mapfile -t sources <<<"$cpp"
if [ "${1:-}" = "--fix" ]; then
  clang-format -i "${sources[@]}"
  exit 0
fi
clang-format --dry-run --Werror "${sources[@]}"
all=$(list '*.hpp' '*.cpp' '*.py' '*.sh' '*.cmake' '*CMakeLists.txt' demo test .ci/run)
mapfile -t licensed <<<"$all"
failed=0
for file in "${licensed[@]}"; do
  if ! head -n 5 "$file" | grep -q 'SPDX-License-Identifier: Apache-2.0'; then
    echo "$file: the SPDX-License-Identifier line is missing" >&2
    failed=1
  fi
done
echo "check_format: ${#sources[@]} sources"
exit $failed
