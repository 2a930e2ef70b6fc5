#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Installs a build, then builds the examples against it as somebody else's project would, and runs
one: install_test.py BUILD_FOLDER SOURCE_FOLDER MAP_WRITER"""
import os
import sys
import tempfile

from command import run


def main():
    build, source, writer = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as folder:
        prefix = os.path.join(folder, "prefix")
        outside = os.path.join(folder, "outside")
        run("cmake", "--install", build, "--prefix", prefix)
        program = os.path.join(prefix, "bin", "parkade")
        assert run(program, "--version").startswith("parkade ")
        models = os.path.join(prefix, "share", "parkade", "models")
        assert any(name.endswith(".onnx") for name in os.listdir(models)), os.listdir(models)
        run("cmake", "-S", os.path.join(source, "examples"), "-B", outside, "-G", "Ninja",
            f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Debug")
        run("cmake", "--build", outside, "--target", "03_use_a_map")
        database = os.path.join(folder, "map.db")
        run(writer, database)
        text = run(os.path.join(outside, "03_use_a_map"), database)
        assert "slots are free" in text, text


if __name__ == "__main__":
    main()
