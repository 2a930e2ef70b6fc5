#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a recording with faults that real sensors have, to see what a run makes of it.

    tools/damage_recording.py SEQ --out BLIND --fault blind:begin=40,seconds=5
    tools/damage_recording.py SEQ --out WORN --fault frozen:camera=cam0,begin=30,seconds=3 --fault dirt:camera=cam2
    build/release/parkade run BLIND --out RUN --method fused && build/release/parkade eval RUN BLIND

Faults, with their defaults; begin counts seconds from the first picture:

    blind:begin=30,seconds=5                no camera gives a picture
    black:begin=30,seconds=5,camera=all     pictures are black
    frozen:begin=30,seconds=3,camera=all    the picture of the beginning comes again and again
    gone:camera=cam0,begin=0                a camera gives none from then on
    drop:share=0.1                          pictures are lost, of each camera by chance
    flicker:gain=2                          brightness of each camera changes every second, by up to that factor
    dirt:camera=cam0,size=0.3               a blurred, bright stain over that share of the width
    late:ms=10                              pictures are stamped later than they were taken
    jitter:ms=2                             their stamps are unsure (standard deviation)
    imu_gap:begin=30,seconds=0.5            the inertial unit is silent
    imu_noise:gyro=0.02,accel=0.3           its readings are noisier (standard deviations, rad/s, m/s^2)
    imu_bias:begin=30,gyro=0.005,accel=0.1  its biases jump by that much along each axis
    imu_scale:share=0.01                    its scales are wrong
    imu_turned:deg=2                        it sits turned about z and y
    imu_broken:count=20                     single readings are broken
    wheel_gap:begin=30,seconds=5            the wheels are silent
    no_wheels                               there are none

Pictures that stay are links into SEQ. The truth stays as it is. Needs Debian's python3-numpy and python3-pil.
"""

import argparse
import os
import pathlib
import shutil
import sys

import numpy as np
from PIL import Image, ImageFilter

NS = 1_000_000_000
DEFAULTS = {
    "blind": {"begin": 30.0, "seconds": 5.0},
    "black": {"begin": 30.0, "seconds": 5.0, "camera": "all"},
    "frozen": {"begin": 30.0, "seconds": 3.0, "camera": "all"},
    "gone": {"camera": "cam0", "begin": 0.0},
    "drop": {"share": 0.1},
    "flicker": {"gain": 2.0},
    "dirt": {"camera": "cam0", "size": 0.3},
    "late": {"ms": 10.0},
    "jitter": {"ms": 2.0},
    "imu_gap": {"begin": 30.0, "seconds": 0.5},
    "imu_noise": {"gyro": 0.02, "accel": 0.3},
    "imu_bias": {"begin": 30.0, "gyro": 0.005, "accel": 0.1},
    "imu_scale": {"share": 0.01},
    "imu_turned": {"deg": 2.0},
    "imu_broken": {"count": 20.0},
    "wheel_gap": {"begin": 30.0, "seconds": 5.0},
    "no_wheels": {},
}


def parse(text):
    """NAME:key=value,... as a name and its settings."""
    name, _, rest = text.partition(":")
    if name not in DEFAULTS:
        raise argparse.ArgumentTypeError(f"unknown fault '{name}'; known: {', '.join(DEFAULTS)}")
    settings = dict(DEFAULTS[name])
    for part in filter(None, rest.split(",")):
        key, _, value = part.partition("=")
        if key not in settings:
            raise argparse.ArgumentTypeError(
                f"{name} has no '{key}'; it takes {', '.join(settings) or 'nothing'}"
            )
        try:
            settings[key] = value if isinstance(settings[key], str) else float(value)
        except ValueError as error:
            raise argparse.ArgumentTypeError(f"{text}: '{value}' is no number") from error
    return name, settings


class Table:
    """A data.csv: its heading, and rows whose first value is a stamp."""

    def __init__(self, path):
        lines = path.read_text(encoding="utf-8").splitlines()
        self.heading = [line for line in lines if line.startswith("#")]
        self.rows = [line.split(",") for line in lines if line and not line.startswith("#")]

    def stamps(self):
        return [int(row[0]) for row in self.rows]

    def drop(self, begin, end):
        self.rows = [row for row in self.rows if not begin <= int(row[0]) < end]

    def write(self, path):
        lines = self.heading + [",".join(row) for row in self.rows]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def span(settings, first):
    begin = first + int(settings["begin"] * NS)
    return begin, begin + int(settings["seconds"] * NS)


class Camera:
    """One camera's table, and what becomes of its pictures: name in the copy to a changed one."""

    def __init__(self, folder):
        self.name = folder.name
        self.folder = folder
        self.table = Table(folder / "data.csv")
        self.changed = {}

    def picture(self, name):
        if name not in self.changed:
            self.changed[name] = Image.open(self.folder / "data" / name).copy()
        return self.changed[name]

    def damage(self, fault, settings, first, random):
        if settings.get("camera", "all") not in ("all", self.name):
            return
        method = getattr(self, fault, None)
        if method:
            method(settings, first, random)

    def blind(self, settings, first, _):
        self.table.drop(*span(settings, first))

    def gone(self, settings, first, _):
        self.table.drop(first + int(settings["begin"] * NS), 2**63)

    def drop(self, settings, _, random):
        self.table.rows = [r for r in self.table.rows if random.random() >= settings["share"]]

    def black(self, settings, first, _):
        begin, end = span(settings, first)
        for stamp, name in self.table.rows:
            if begin <= int(stamp) < end:
                size, mode = self.picture(name).size, self.picture(name).mode
                self.changed[name] = Image.new(mode, size)

    def frozen(self, settings, first, _):
        begin, end = span(settings, first)
        held = None
        for row in self.table.rows:
            if begin <= int(row[0]) < end:
                held = held or row[1]
                row[1] = held

    def flicker(self, settings, first, random):
        strength = np.log(settings["gain"])
        gains = np.exp(random.uniform(-strength, strength, 100_000))
        for stamp, name in self.table.rows:
            gain = gains[(int(stamp) - first) // NS]
            self.changed[name] = self.picture(name).point(lambda v, g=gain: min(255, round(g * v)))

    def dirt(self, settings, _, random):
        width, height = self.picture(self.table.rows[0][1]).size
        radius = 0.5 * settings["size"] * width
        x, y = random.uniform(0.3, 0.7) * width, random.uniform(0.4, 0.7) * height
        v, u = np.mgrid[0:height, 0:width]
        share = np.clip(2.0 * (1.0 - np.hypot(u - x, v - y) / radius), 0.0, 0.85)
        mask = Image.fromarray((255 * share).astype(np.uint8))
        for _, name in self.table.rows:
            picture = self.picture(name)
            stain = picture.filter(ImageFilter.GaussianBlur(0.02 * width)).point(
                lambda v: min(255, round(90 + 0.5 * v))
            )
            picture.paste(stain, mask=mask)

    def late(self, settings, _, __):
        for row in self.table.rows:
            row[0] = str(int(row[0]) + int(settings["ms"] * 1e6))

    def jitter(self, settings, _, random):
        for row in self.table.rows:
            row[0] = str(int(row[0]) + int(settings["ms"] * 1e6 * random.normal()))

    def write(self, folder):
        (folder / "data").mkdir(parents=True)
        self.table.write(folder / "data.csv")
        for name in {row[1] for row in self.table.rows}:
            path = folder / "data" / name
            if name in self.changed:
                self.changed[name].save(path, quality=95)
            else:
                path.symlink_to((self.folder / "data" / name).resolve())


class Readings:
    """Those of an inertial unit; a method for each fault of it, named alike."""

    def __init__(self, table, first):
        self.table = table
        self.first = first
        self.values = np.array([[float(value) for value in row[1:]] for row in table.rows])
        self.gyro, self.accel = self.values[:, :3], self.values[:, 3:6]

    def imu_noise(self, settings, random):
        self.gyro += random.normal(0.0, settings["gyro"], self.gyro.shape)
        self.accel += random.normal(0.0, settings["accel"], self.accel.shape)

    def imu_bias(self, settings, _):
        late = np.array(self.table.stamps()) >= self.first + int(settings["begin"] * NS)
        self.gyro[late] += settings["gyro"]
        self.accel[late] += settings["accel"]

    def imu_scale(self, settings, _):
        self.values *= 1.0 + settings["share"]

    def imu_turned(self, settings, _):
        c, s = np.cos(np.radians(settings["deg"])), np.sin(np.radians(settings["deg"]))
        about_z = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        about_y = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
        turn = about_z @ about_y
        self.gyro[:] = self.gyro @ turn.T
        self.accel[:] = self.accel @ turn.T

    def imu_broken(self, settings, random):
        count = min(int(settings["count"]), len(self.values))
        broken = random.choice(len(self.values), count, replace=False)
        self.gyro[broken] += random.normal(0.0, 3.0, (count, 3))
        self.accel[broken] += random.normal(0.0, 50.0, (count, 3))

    def store(self):
        for row, value in zip(self.table.rows, self.values):
            row[1:] = [repr(float(v)) for v in value]


def copy_rest(source, target, done):
    """All that is no sensor's folder, as links."""
    for entry in sorted(source.iterdir()):
        if entry.name in done:
            continue
        if entry.name == "mav0":
            (target / "mav0").mkdir(exist_ok=True)
            copy_rest(entry, target / "mav0", done)
        elif entry.name == "rig.yaml":
            shutil.copy(entry, target / entry.name)
        else:
            (target / entry.name).symlink_to(entry.resolve())


def damage(source, target, faults, seed):
    mav = source / "mav0"
    cameras = [Camera(f) for f in sorted(mav.glob("cam[0-9]*")) if (f / "data.csv").exists()]
    if not cameras:
        sys.exit(f"{source}: no recording (it holds no mav0/cam0/data.csv)")
    known = {camera.name for camera in cameras} | {"all"}
    for _, settings in faults:
        if settings.get("camera", "all") not in known:
            sys.exit(f"{source}: no camera '{settings['camera']}'; there are {sorted(known)}")
    first = min(stamp for camera in cameras for stamp in camera.table.stamps())
    done = {camera.name for camera in cameras} | {"imu0", "wheel0"}
    tables = {n: Table(mav / n / "data.csv") for n in ("imu0", "wheel0") if (mav / n).is_dir()}
    for fault, settings in faults:
        sensor = {"imu_gap": "imu0", "wheel_gap": "wheel0"}.get(fault)
        if sensor in tables:
            tables[sensor].drop(*span(settings, first))
        if fault == "no_wheels":
            tables.pop("wheel0", None)
        if hasattr(Readings, fault) and "imu0" in tables:
            readings = Readings(tables["imu0"], first)
            getattr(readings, fault)(settings, np.random.default_rng([seed, len(cameras)]))
            readings.store()
    target.mkdir(parents=True)
    for number, camera in enumerate(cameras):
        random = np.random.default_rng([seed, number])
        for fault, settings in faults:
            camera.damage(fault, settings, first, random)
        camera.write(target / "mav0" / camera.name)
        camera.changed.clear()
    for name, table in tables.items():
        (target / "mav0" / name).mkdir(parents=True)
        table.write(target / "mav0" / name / "data.csv")
    copy_rest(source, target, done)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=pathlib.Path, help="recording to read")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to make")
    parser.add_argument("--fault", type=parse, action="append", required=True)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    if os.path.lexists(arguments.out):
        sys.exit(f"{arguments.out}: is there already; take another --out")
    damage(arguments.sequence, arguments.out, arguments.fault, arguments.seed)


if __name__ == "__main__":
    main()
