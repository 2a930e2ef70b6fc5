#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that every room includes only what docs/architecture.md allows.

A room is a folder under src/parkade. The table below names what each room may include directly; it
may also include what those may include. Test sources obey the same table. Exit code 0: clean, 1:
violations, one line each: file:line: message.
"""

import argparse
import pathlib
import re
import sys

# room: (level, rooms that it may include)
ROOMS = {
    "core": (0, []),
    "geometry": (1, ["core"]),
    "camera": (2, ["geometry"]),
    "imu": (2, ["geometry"]),
    "types": (2, ["geometry"]),
    "io": (3, ["types", "camera"]),
    "tracking": (3, ["types", "camera"]),
    "vio": (3, ["types", "camera", "imu"]),
    "bev": (3, ["types", "camera"]),
    "semantics": (3, ["types", "camera"]),
    "fusion": (3, ["types", "imu"]),
    "mapping": (3, ["types"]),
    "localization": (4, ["mapping"]),
    "sim": (4, ["types", "camera", "imu"]),
    "eval": (4, ["types", "mapping"]),
    "pipeline": (5, ["localization", "fusion", "semantics", "bev", "vio", "tracking", "io"]),
    "viewer": (6, ["pipeline", "mapping"]),
    "cli": (7, ["viewer", "pipeline", "eval", "sim"]),
}

# Third-party headers and the only rooms that may include them; elsewhere they may not appear.
RESTRICTED = {
    r"ceres/": {"vio", "mapping", "localization"},
    r"dnnl|omp\.h|onnx/": {"semantics"},
    r"embree3/": {"sim"},
    r"sqlite3\.h": {"mapping"},
    r"httplib\.h": {"viewer"},
    r"CLI/": {"cli"},
    r"spdlog/": {"cli"},
    r"opencv2/(?!core)": {"tracking", "bev", "semantics", "io", "mapping", "sim"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def allowed_rooms(room):
    """The room itself and all that it may include, directly or through others."""
    seen, todo = {room}, [room]
    while todo:
        for other in ROOMS[todo.pop()][1]:
            if other not in seen:
                seen.add(other)
                todo.append(other)
    return seen


def check_file(path, room):
    """Violations of one source file as strings."""
    problems = []
    allowed = allowed_rooms(room)
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        match = INCLUDE.match(line)
        if not match:
            continue
        header = match.group(1)
        if header.startswith("parkade/"):
            target = header.split("/")[1]
            if target not in ROOMS:
                problems.append(f"{path}:{number}: '{header}' is in no known room")
            elif target not in allowed:
                problems.append(
                    f"{path}:{number}: room '{room}' (level {ROOMS[room][0]}) may not include "
                    f"'{header}' of room '{target}' (level {ROOMS[target][0]})"
                )
        elif header.startswith("../") or "/../" in header:
            problems.append(f"{path}:{number}: include '{header}' by its full path parkade/ROOM/...")
        for pattern, rooms in RESTRICTED.items():
            if re.match(pattern, header) and room not in rooms:
                problems.append(
                    f"{path}:{number}: '{header}' is kept to {', '.join(sorted(rooms))}; "
                    f"room '{room}' may not include it"
                )
    return problems


def check_table():
    """Each room may include lower levels only."""
    return [
        f"table: room '{room}' (level {level}) lists '{other}' (level {ROOMS[other][0]})"
        for room, (level, others) in ROOMS.items()
        for other in others
        if ROOMS[other][0] >= level
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    default_root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--root", type=pathlib.Path, default=default_root, help="repository root")
    args = parser.parse_args()
    rooms_folder = args.root / "src" / "parkade"
    problems = check_table()
    count = 0
    for folder in sorted(p for p in rooms_folder.iterdir() if p.is_dir()):
        if folder.name not in ROOMS:
            problems.append(f"{folder}: not a room of the table in tools/check_layers.py")
            continue
        for path in sorted(folder.rglob("*")):
            if path.suffix in {".hpp", ".cpp", ".h", ".cc"}:
                count += 1
                problems += check_file(path, folder.name)
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"check_layers: {count} files, {len(problems)} violations")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
