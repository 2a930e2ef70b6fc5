# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes rig.yaml files (docs/formats.md) for the tools beside it."""

import numpy as np

# Bosch BMI088 at 200 Hz: parkade's defaults (src/parkade/camera/rig.hpp).
BMI088 = {
    "gyroscope_noise_density": 2.44e-4,
    "gyroscope_random_walk": 2e-5,
    "accelerometer_noise_density": 1.86e-3,
    "accelerometer_random_walk": 2e-4,
    "rate": 200,
}

# A camera whose optical axis is the vehicle's x axis: image right is -y, image down is -z.
R_VEHICLE_FORWARD = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


def rotation(yaw_deg=0.0, pitch_deg=0.0, roll_deg=0.0):
    """Rz(yaw) Ry(pitch) Rx(roll); a positive pitch turns the x axis downwards."""
    (cy, sy), (cp, sp), (cr, sr) = [
        (np.cos(np.radians(a)), np.sin(np.radians(a))) for a in (yaw_deg, pitch_deg, roll_deg)
    ]
    return (
        np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
        @ np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
        @ np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    )


def nearest_rotation(matrix):
    """The rotation nearest to a matrix that was printed with few digits."""
    u, _, vt = np.linalg.svd(matrix)
    return u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt


def rounded(matrix):
    """To 12 decimals: the same text from every linear algebra library."""
    return np.round(matrix, 12)


def transform(rotation_matrix, translation):
    """4x4 from rotation and translation."""
    result = np.eye(4)
    result[:3, :3] = rotation_matrix
    result[:3, 3] = translation
    return rounded(result)


def number(value):
    """The shortest text that reads back as the same number."""
    value = float(value)
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)


def numbers(values):
    """A YAML list of numbers."""
    return "[" + ", ".join(number(v) for v in values) + "]"


def matrix_lines(key, matrix, indent):
    """A 4x4 matrix as nested rows."""
    pad = " " * indent
    return [f"{pad}{key}:"] + [f"{pad}  - {numbers(row)}" for row in matrix]


def rig_text(name, comment, cameras, T_vehicle_imu, imu, vehicle=None, imu_comment=None):
    """The file's text. cameras: dicts with name, comment, camera_model, intrinsics,
    distortion_model, distortion_coeffs, resolution, T_vehicle_cam and, optionally, rate."""
    lines = [
        "# SPDX-FileCopyrightText: 2026 The Parkade authors",
        "# SPDX-License-Identifier: Apache-2.0",
        "#",
    ]
    lines += [f"# {line}".rstrip() for line in comment.strip().splitlines()]
    lines.append(f"name: {name}")
    if vehicle is not None:
        lines.append("vehicle:")
        lines += [f"  {key}: {number(value)}" for key, value in vehicle.items()]
    lines.append("cameras:")
    for camera in cameras:
        lines.append(f"  - name: {camera['name']}  # {camera['comment']}")
        lines.append(f"    camera_model: {camera['camera_model']}")
        lines.append(f"    intrinsics: {numbers(camera['intrinsics'])}")
        lines.append(f"    distortion_model: {camera['distortion_model']}")
        lines.append(f"    distortion_coeffs: {numbers(camera['distortion_coeffs'])}")
        lines.append(f"    resolution: [{camera['resolution'][0]}, {camera['resolution'][1]}]")
        lines += matrix_lines("T_vehicle_cam", camera["T_vehicle_cam"], 4)
        if "rate" in camera:
            lines.append(f"    rate: {number(camera['rate'])}")
    lines.append("imu:" + (f"  # {imu_comment}" if imu_comment else ""))
    lines += matrix_lines("T_vehicle_imu", T_vehicle_imu, 2)
    lines += [f"  {key}: {number(value)}" for key, value in imu.items()]
    return "\n".join(lines) + "\n"
