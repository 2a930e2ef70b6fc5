#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the simulator's rigs (avp6, nuscenes6, avm4) from the mounting tables below.

    python3 tools/make_rigs.py --out config/rigs
"""

import argparse
import pathlib

from rig_format import BMI088, R_VEHICLE_FORWARD, rig_text, rotation, transform

# The car of all three: the defaults of VehicleShape (src/parkade/camera/rig.hpp).
CAR = {
    "wheelbase": 2.85,
    "track": 1.6,
    "front_overhang": 0.9,
    "rear_overhang": 1.0,
    "width": 1.86,
    "height": 1.48,
}

# Beside the centre tunnel, and as crooked as a unit is after fitting.
T_VEHICLE_IMU = transform(rotation(0.6, -0.4, 0.3), [1.25, 0.12, 0.42])


def mounted(name, place, position, yaw_deg, pitch_deg, lens):
    """A camera at a position (m, vehicle frame), yaw to the left and pitch downwards in degrees."""
    return {
        "name": name,
        "comment": f"{place}: yaw {yaw_deg:g} deg, {pitch_deg:g} deg down",
        "T_vehicle_cam": transform(rotation(yaw_deg, pitch_deg) @ R_VEHICLE_FORWARD, position),
        **lens,
    }


def avp6():
    """Six wide cameras, placed as on series cars with side cameras in fenders and B-pillars."""
    lens = {
        "camera_model": "pinhole",
        "intrinsics": [290, 290, 319.5, 199.5],
        "distortion_model": "equidistant",
        "distortion_coeffs": [0.01, -0.004, 0.0006, -0.0001],
        "resolution": [640, 400],
        "rate": 10,
    }
    cameras = [
        mounted("cam0", "front, in the grille", [3.77, 0.0, 0.65], 0, 15, lens),
        mounted("cam1", "left B-pillar, forwards", [1.3, 0.95, 1.15], 60, 22, lens),
        mounted("cam2", "left front fender, backwards", [2.6, 0.95, 0.8], 122, 22, lens),
        mounted("cam3", "rear, above the plate", [-1.02, 0.0, 0.9], 180, 22, lens),
        mounted("cam4", "right front fender, backwards", [2.6, -0.95, 0.8], -122, 22, lens),
        mounted("cam5", "right B-pillar, forwards", [1.3, -0.95, 1.15], -60, 22, lens),
    ]
    comment = """
Six wide cameras, counter-clockwise from the front, on an ordinary car: the default rig of the
simulator. Fisheye lenses of 126 deg across and 79 deg down. Together they see the ground all
around from less than 1.0 m outside the body; neighbours overlap by more than 20 deg
(src/parkade/camera/rig_coverage_test.cpp). Made by tools/make_rigs.py."""
    return rig_text("avp6", comment, cameras, T_VEHICLE_IMU, BMI088, CAR)


def nuscenes6():
    """The six roof cameras of nuScenes at half resolution."""

    def lens(focal):
        # Full size: 1600 x 900; pixel centres at integers, so the centre of the half is 399.5, 224.5.
        return {
            "camera_model": "pinhole",
            "intrinsics": [focal / 2, focal / 2, 399.5, 224.5],
            "distortion_model": "none",
            "distortion_coeffs": [],
            "resolution": [800, 450],
            "rate": 10,
        }

    cameras = [
        mounted("cam0", "CAM_FRONT", [1.701, 0.016, 1.511], 0, 0, lens(1266)),
        mounted("cam1", "CAM_FRONT_LEFT", [1.524, 0.495, 1.509], 55, 0, lens(1273)),
        mounted("cam2", "CAM_BACK_LEFT", [1.036, 0.485, 1.591], 110, 0, lens(1257)),
        mounted("cam3", "CAM_BACK", [0.028, 0.003, 1.579], 180, 0, lens(809)),
        mounted("cam4", "CAM_BACK_RIGHT", [1.015, -0.481, 1.562], -110, 0, lens(1260)),
        mounted("cam5", "CAM_FRONT_RIGHT", [1.551, -0.493, 1.496], -55, 0, lens(1260)),
    ]
    comment = """
The six roof cameras of nuScenes (Caesar et al., CVPR 2020), counter-clockwise from the front:
places and focal lengths of the data set, yaws to 1 deg, principal points in the middle, half
resolution (1600 x 900 there), 10 Hz (12 Hz there), on the simulator's car. Narrow and high: they see
the ground only from some metres on. Made by tools/make_rigs.py."""
    return rig_text("nuscenes6", comment, cameras, T_VEHICLE_IMU, BMI088, CAR)


def avm4():
    """Four fisheyes, as surround-view monitors have them."""
    lens = {
        "camera_model": "pinhole",
        "intrinsics": [239, 239, 479.5, 359.5],
        "distortion_model": "equidistant",
        # The lens of garage_fisheye_real's front camera, fitted from 0 to 97 deg to 0.2 px.
        "distortion_coeffs": [0.1587, -0.0029, -0.01479, 0.002783],
        "resolution": [960, 720],
        "rate": 10,
    }
    cameras = [
        mounted("cam0", "front, in the grille", [3.77, 0.0, 0.65], 0, 25, lens),
        mounted("cam1", "left mirror", [2.05, 1.02, 1.0], 90, 45, lens),
        mounted("cam2", "rear, above the plate", [-1.02, 0.0, 0.9], 180, 30, lens),
        mounted("cam3", "right mirror", [2.05, -1.02, 1.0], -90, 45, lens),
    ]
    comment = """
Four fisheye cameras of 183 deg across, as surround-view monitors have them: front, left mirror, rear,
right mirror. Made by tools/make_rigs.py."""
    return rig_text("avm4", comment, cameras, T_VEHICLE_IMU, BMI088, CAR)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--out", type=pathlib.Path, default=root / "config" / "rigs")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    for make in (avp6, nuscenes6, avm4):
        path = args.out / f"{make.__name__}.yaml"
        path.write_text(make(), encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
