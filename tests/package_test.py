#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the Debian packages of a build and runs the program out of one: package_test.py BUILD_FOLDER"""
import pathlib
import shutil
import sys
import tempfile

from command import run


def field(package, name):
    return run("dpkg-deb", "--field", package, name).strip()


def main():
    build = sys.argv[1]
    if shutil.which("dpkg-shlibdeps") is None:
        print("skipped: no dpkg-shlibdeps (Debian's dpkg-dev)")
        return
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run("cpack", "--config", f"{build}/CPackConfig.cmake", "-B", folder / "made")
        (program,) = (folder / "made").glob("parkade_*.deb")
        (development,) = (folder / "made").glob("libparkade-dev_*.deb")

        depends = field(program, "Depends")
        for library in ("libopencv-dnn", "libsqlite3-0", "libdnnl", "libembree"):
            assert library in depends, depends
        version = field(program, "Version")
        assert f"parkade (= {version})" in field(development, "Depends")

        root = folder / "root"
        run("dpkg-deb", "--extract", program, root)
        assert version in run(root / "usr/bin/parkade", "--version")
        installed = {str(path.relative_to(root / "usr/share/parkade")) for path in root.rglob("share/parkade/*/*")}
        for needed in ("models/bev_segmentation.onnx", "models/zone_text.yaml", "rigs/nuscenes6.yaml"):
            assert needed in installed, sorted(installed)

        run("dpkg-deb", "--extract", development, root)
        assert (root / "usr/include/parkade/pipeline/mapping_run.hpp").exists()
        assert list(root.rglob("ParkadeConfig.cmake")) and list(root.rglob("libparkade_vio.a"))
        assert not list(root.rglob("include/parkade/cli"))


if __name__ == "__main__":
    main()
