#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a rig.yaml for each recorded data set from the calibration that came with it.

    python3 tools/convert_rigs.py --data ../shared/data --out config/rigs

Needs python3-numpy and python3-yaml. Each file's heading says what was known and what was chosen.
All results are in the vehicle frame: x forward, y left, z up, origin on the ground below the middle
of the rear axle, metres.
"""

import argparse
import json
import pathlib

import numpy as np
import yaml

from rig_format import BMI088, nearest_rotation, rig_text, transform

NO_IMU = "none was recorded: a BMI088 at the origin"


def read_opencv_yaml(path):
    """A YAML file with OpenCV's heading."""
    return yaml.safe_load(path.read_text(encoding="utf-8").replace("%YAML:1.0\n---", ""))


def inverse(T):
    """Of a rigid motion."""
    result = np.eye(4)
    result[:3, :3] = T[:3, :3].T
    result[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return result


def garage_fisheye_real(data):
    """OpenCalib's surround-view sample in a car park."""
    folder = data / "garage_fisheye_real"
    # Depth of the ground below the virtual camera, in the extrinsics' unit, per camera: bev2ground in
    # OpenCalib's surround-camera/manual_calib/src/run_avm.cpp. That they differ means that every
    # camera came out at its own scale; the translations are brought to one here.
    depths = {"Front": 6.07826, "Left": 6.25217, "Back": 6.31014, "Right": 6.28116}
    depth = 6.25
    metres_per_unit = 0.5
    rear_camera_to_axle = 1.12
    # The virtual camera looks down with its image's top ahead: x right, y backward, z down.
    T_ground_bev = np.array(
        [[0, -1, 0, 0], [-1, 0, 0, 0], [0, 0, -1, depth], [0, 0, 0, 1]], dtype=float
    )

    def value(kind, name, field):
        text = (folder / kind / f"{name}.json").read_text(encoding="utf-8")
        return np.array(next(iter(json.loads(text).values()))["param"][field]["data"], dtype=float)

    poses = {}
    for name, own_depth in depths.items():
        T_cam_bev = value("extrinsic", name, "sensor_calib")
        T_cam_bev[:3, :3] = nearest_rotation(T_cam_bev[:3, :3])
        T_cam_bev[:3, 3] *= depth / own_depth
        poses[name] = T_ground_bev @ inverse(T_cam_bev)
        poses[name][:3, 3] *= metres_per_unit
    axle_x = poses["Back"][0, 3] + rear_camera_to_axle
    cameras = []
    for index, name in enumerate(["Front", "Left", "Back", "Right"]):
        pose = poses[name]
        pose[0, 3] -= axle_x
        K = value("intrinsic", name, "cam_K")
        cameras.append(
            {
                "name": f"cam{index}",
                "comment": f"imgs/{name}.png",
                "camera_model": "ocam",
                "intrinsics": [K[0, 2], K[1, 2], K[0, 0], K[0, 1], K[1, 0], K[1, 1]],
                "distortion_model": "polynomial",
                "distortion_coeffs": value("intrinsic", name, "cam_dist").ravel(),
                "resolution": [1280, 960],
                "T_vehicle_cam": transform(pose[:3, :3], pose[:3, 3]),
            }
        )
    comment = """
Four fisheyes of a car in an underground car park (OpenCalib's surround-camera sample, Apache-2.0).
Known: intrinsics; poses relative to a virtual camera that looks down on the car, each with its own
depth of the ground (6.08 to 6.31 units), brought to one scale here.
Chosen: 1 unit = 0.5 m, which makes the speed bump 0.35 m wide with segments of 0.5 m, the slots 2.4
to 2.5 m wide and the pillar guards 1.1 to 1.3 m high (a few percent are open). The rear axle 1.12 m
ahead of the rear camera, and the body's size, are estimates from the pictures.
Made by tools/convert_rigs.py."""
    vehicle = {
        "wheelbase": 2.92,
        "track": 1.6,
        "front_overhang": 0.97,
        "rear_overhang": 1.12,
        "width": 1.81,
        "height": 1.5,
    }
    return rig_text(
        "garage_fisheye_real", comment, cameras, np.eye(4), BMI088, vehicle, imu_comment=NO_IMU
    )


def garage_fisheye_sim(data):
    """Four MEI cameras of another simulator."""
    folder = data / "garage_fisheye_sim"
    centre_to_axle = 1.42
    # Theirs: x right, y forward, z up, origin between the bumper cameras.
    T_vehicle_theirs = np.array(
        [[0, 1, 0, centre_to_axle], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], dtype=float
    )
    cameras = []
    for index, place in enumerate(["front", "rear", "left", "right"]):
        intrinsic = read_opencv_yaml(folder / f"{index}_intrinsic.yaml")
        extrinsic = read_opencv_yaml(folder / f"{index}_extrinsic.yaml")["transform"]
        q = np.array([extrinsic["rotation"][axis] for axis in "xyzw"], dtype=float)
        x, y, z, w = q / np.linalg.norm(q)
        T_theirs_cam = np.eye(4)
        T_theirs_cam[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        T_theirs_cam[:3, 3] = [extrinsic["translation"][axis] for axis in "xyz"]
        T = T_vehicle_theirs @ T_theirs_cam
        mirror = intrinsic["mirror_parameters"]
        projection = intrinsic["projection_parameters"]
        distortion = intrinsic["distortion_parameters"]
        cameras.append(
            {
                "name": f"cam{index}",
                "comment": f"{index}.png, {place}",
                "camera_model": "omni",
                "intrinsics": [
                    mirror["xi"],
                    projection["gamma1"],
                    projection["gamma2"],
                    projection["u0"],
                    projection["v0"],
                ],
                "distortion_model": "radtan",
                "distortion_coeffs": [distortion[key] for key in ("k1", "k2", "p1", "p2")],
                "resolution": [intrinsic["image_width"], intrinsic["image_height"]],
                "T_vehicle_cam": transform(T[:3, :3], T[:3, 3]),
            }
        )
    comment = """
Four fisheyes (MEI) of a simulated car in a simulated car park.
Known: intrinsics; poses in a frame between the bumper cameras, in metres (their quaternions have three
digits). ipm_img.png is the ground from 10 m ahead to 10 m behind that frame's origin at 0.02 m per
pixel. Chosen: the rear axle 1.42 m behind that origin (it is not given; the rear wheels stand there in
the pictures, to 0.1 m). The body's size is an estimate from the pictures.
Made by tools/convert_rigs.py."""
    vehicle = {
        "wheelbase": 2.84,
        "track": 1.6,
        "front_overhang": 1.06,
        "rear_overhang": 1.06,
        "width": 1.9,
        "height": 1.42,
    }
    return rig_text(
        "garage_fisheye_sim", comment, cameras, np.eye(4), BMI088, vehicle, imu_comment=NO_IMU
    )


def roecs_fisheye_real(data):
    """ROECS set 1."""
    metres_per_unit = 0.089
    rear_camera_to_axle = 0.5
    lens, poses = {}, {}
    text = (data / "roecs_fisheye_real" / "calibration_roecs.txt").read_text(encoding="utf-8")
    # The ground's frame: x right, y forward, z up, on the ground.
    T_vehicle_ground = np.array(
        [[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], dtype=float
    )
    for line in text.splitlines():
        name, rest = line.split(" ", 1)
        if name == "#":
            continue
        if "|" in rest:
            lens[name] = [[float(v) for v in part.split()] for part in rest.split("|")]
        else:
            T_cam_ground = np.eye(4)
            T_cam_ground[:3] = np.array(rest.split(), dtype=float).reshape(3, 4)
            T_cam_ground[:3, :3] = nearest_rotation(T_cam_ground[:3, :3])
            poses[name] = T_vehicle_ground @ inverse(T_cam_ground)
            poses[name][:3, 3] *= metres_per_unit
    axle_x = poses["B"][0, 3] + rear_camera_to_axle
    cameras = []
    for index, (name, place) in enumerate(
        [("F", "front"), ("L", "left"), ("B", "rear"), ("R", "right")]
    ):
        pose = poses[name]
        pose[0, 3] -= axle_x
        cameras.append(
            {
                "name": f"cam{index}",
                "comment": f"samples/1_{name}.jpg, {place}",
                "camera_model": "pinhole",
                "intrinsics": lens[name][0],
                "distortion_model": "equidistant",
                "distortion_coeffs": lens[name][1],
                "resolution": [1280, 1080],
                "T_vehicle_cam": transform(pose[:3, :3], pose[:3, 3]),
            }
        )
    comment = """
Four fisheyes on the roof of a small open car (ROECS, set 1; the numbers do not hold for set 2).
Known: intrinsics (OpenCV's fisheye model); poses relative to the ground in units near a decimetre.
Chosen: 1 unit = 0.089 m. The road's broken yellow line repeats every 67.5 units with dashes of 22 units,
one third of it, as in the Chinese standard GB 5768 (2 m of line, 4 m of gap); the lanes are then 3.4 and
3.7 m wide. Some percent are open. The rear axle 0.5 m ahead of the rear camera, and the body's size, are
estimates from the pictures. Made by tools/convert_rigs.py."""
    vehicle = {
        "wheelbase": 1.9,
        "track": 1.0,
        "front_overhang": 0.65,
        "rear_overhang": 0.5,
        "width": 1.2,
        "height": 1.8,
    }
    return rig_text(
        "roecs_fisheye_real", comment, cameras, np.eye(4), BMI088, vehicle, imu_comment=NO_IMU
    )


def euroc(data):
    """EuRoC MAV: the sensor.yaml files in one."""
    folder = data / "euroc_mh01_16s" / "mav0"

    def sensor(name):
        return yaml.safe_load((folder / name / "sensor.yaml").read_text(encoding="utf-8"))

    cameras = []
    for name in ("cam0", "cam1"):
        values = sensor(name)
        cameras.append(
            {
                "name": name,
                "comment": values["comment"],
                "camera_model": values["camera_model"],
                "intrinsics": values["intrinsics"],
                "distortion_model": "radtan",
                "distortion_coeffs": values["distortion_coefficients"],
                "resolution": values["resolution"],
                "T_vehicle_cam": np.array(values["T_BS"]["data"], dtype=float).reshape(4, 4),
                "rate": values["rate_hz"],
            }
        )
    values = sensor("imu0")
    imu = {key: float(values[key]) for key in BMI088 if key != "rate"}
    imu["rate"] = values["rate_hz"]
    comment = """
EuRoC MAV (Burri et al., IJRR 2016): the stereo pair and IMU of a micro aerial vehicle, from its
sensor.yaml files without a change. There is no car: the vehicle frame is the body, which is the IMU.
Made by tools/convert_rigs.py."""
    T_vehicle_imu = np.array(values["T_BS"]["data"], dtype=float).reshape(4, 4)
    return rig_text(
        "euroc", comment, cameras, T_vehicle_imu, imu, imu_comment=values["comment"]
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--data", type=pathlib.Path, default=root.parent / "shared" / "data")
    parser.add_argument("--out", type=pathlib.Path, default=root / "config" / "rigs")
    args = parser.parse_args()
    if not args.data.is_dir():
        parser.error(f"--data {args.data}: no such folder")
    args.out.mkdir(parents=True, exist_ok=True)
    for convert in (garage_fisheye_real, garage_fisheye_sim, roecs_fisheye_real, euroc):
        path = args.out / f"{convert.__name__}.yaml"
        path.write_text(convert(args.data), encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
