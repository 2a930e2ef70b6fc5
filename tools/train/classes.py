# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""What the networks tell apart, and how they relate to the program's classes.

The numbers are those of src/parkade/types/semantic_class.hpp, as label images hold them.
"""
import numpy as np

SEMANTIC_CLASSES = [
    "unknown", "floor", "slot_line", "lane_line", "arrow", "speed_limit_paint", "stop_line",
    "crossing", "speed_bump", "painted_number", "wheel_stop", "pillar", "wall", "ceiling",
    "vehicle", "pedestrian", "zone_marker", "guide_sign", "speed_limit_sign",
]

IGNORE = 255  # in label images: no camera sees this place

BEV_CLASSES = [
    "unknown", "floor", "slot_line", "lane_line", "arrow", "speed_limit_paint", "stop_line",
    "crossing", "speed_bump", "painted_number", "wheel_stop", "pillar", "wall", "vehicle",
    "pedestrian",
]
RAW_CLASSES = [
    "unknown", "vehicle", "pedestrian", "pillar", "zone_marker", "guide_sign", "speed_limit_sign",
]

# Classes that a network does not tell apart from one that it knows.
BEV_MERGED = {"zone_marker": "pillar"}
RAW_MERGED = {}

NETWORKS = {
    "bev": {"classes": BEV_CLASSES, "merged": BEV_MERGED, "size": (384, 384)},
    "raw": {"classes": RAW_CLASSES, "merged": RAW_MERGED, "size": (320, 192)},
}
# Pixels of a picture for each one that is labelled, either way.
PX_PER_LABEL = {"bev": 1, "raw": 1}


def is_validation(garage):
    """Whether a garage seed is kept for validation."""
    return garage % 10 == 3


def label_table(network):
    """Label image value -> output channel of the network, 256 entries; IGNORE stays."""
    spec = NETWORKS[network]
    table = np.zeros(256, np.uint8)
    for value, name in enumerate(SEMANTIC_CLASSES):
        name = spec["merged"].get(name, name)
        if name in spec["classes"]:
            table[value] = spec["classes"].index(name)
    table[IGNORE] = IGNORE
    return table
