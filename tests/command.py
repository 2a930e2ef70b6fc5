# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that a test cannot go on without."""
import subprocess
import sys


def run(*command, **options):
    """What a command prints; ends the test with its output where it fails."""
    command = [str(part) for part in command]
    result = subprocess.run(command, capture_output=True, text=True, timeout=1200, **options)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout
