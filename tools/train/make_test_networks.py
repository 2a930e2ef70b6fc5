#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the networks that the tests of src/parkade/semantics load: a few numbers by hand.

    tools/train/make_test_networks.py tests/data/networks

bright.onnx    3 classes by brightness, any size, one channel per class: what a user brings
blocks.onnx    2 classes by brightness, four channels per class at half the size
coarse.onnx    the same, of the means of 2 x 2 px: labels of camera views at half the size
vector.onnx    no picture comes out
layers.onnx    all kinds of layers that are compiled, in all places where they may stand
sigmoid.onnx   one that is not
"""
import os
import sys

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper


def save(folder, name, nodes, weights, size, output):
    shape = [1, 3, *size]
    graph = helper.make_graph(
        nodes, name,
        [helper.make_tensor_value_info("picture", TensorProto.FLOAT, shape)],
        [helper.make_tensor_value_info("logits", TensorProto.FLOAT, output)],
        [numpy_helper.from_array(value.astype(np.float32), key) for key, value in weights.items()])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 12)],
                              producer_name="parkade")
    model.ir_version = 7
    onnx.save(model, os.path.join(folder, name + ".onnx"))


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    # The input is (value - 127.5) / 127.5; logits -g, 0.5, g for the mean g of the channels: dark
    # below -0.5, bright above 0.5.
    mean = np.full((1, 3, 1, 1), 1.0 / 3.0)
    save(folder, "bright",
         [helper.make_node("Conv", ["picture", "w", "b"], ["logits"], kernel_shape=[1, 1])],
         {"w": np.concatenate([-mean, 0 * mean, mean]), "b": np.array([0.0, 0.5, 0.0])}, (32, 48),
         [1, 3, 32, 48])
    # A 2 x 2 convolution of stride 2 that hands each pixel of a block to a channel of its own.
    kernel = np.zeros((8, 3, 2, 2))
    for part in range(4):
        kernel[part, :, part // 2, part % 2] = -1.0 / 3.0
        kernel[4 + part, :, part // 2, part % 2] = 1.0 / 3.0
    save(folder, "blocks",
         [helper.make_node("Conv", ["picture", "w"], ["logits"], kernel_shape=[2, 2],
                           strides=[2, 2])], {"w": kernel}, (16, 16), [1, 8, 8, 8])
    # Likewise, of the means of 2 x 2 px.
    coarse = 0.25 * kernel.repeat(2, 2).repeat(2, 3)
    save(folder, "coarse",
         [helper.make_node("Conv", ["picture", "w"], ["logits"], kernel_shape=[4, 4],
                           strides=[4, 4])], {"w": coarse}, (16, 16), [1, 8, 4, 4])
    save(folder, "vector",
         [helper.make_node("GlobalAveragePool", ["picture"], ["pooled"]),
          helper.make_node("Flatten", ["pooled"], ["logits"])], {}, (16, 16),
         [1, 3])
    save_layers(folder)
    save(folder, "sigmoid",
         [helper.make_node("Conv", ["picture", "w"], ["sums"], kernel_shape=[1, 1]),
          helper.make_node("Sigmoid", ["sums"], ["logits"])],
         {"w": np.full((1, 3, 1, 1), 1.0)}, (16, 16), [1, 1, 16, 16])


def save_layers(folder):
    """Sums in place and not, rectifiers behind convolutions, behind sums and alone, a sum with the picture."""
    random = np.random.default_rng(7)
    weights, nodes = {}, []

    def convolve(source, output, channels, kernel, **attributes):
        weights[output + ".w"] = random.normal(0.0, 0.2, (*channels, *kernel))
        weights[output + ".b"] = random.normal(0.0, 0.2, channels[:1])
        nodes.append(helper.make_node("Conv", [source, output + ".w", output + ".b"], [output],
                                      kernel_shape=kernel, **attributes))

    def apply(operator, sources, output, **attributes):
        nodes.append(helper.make_node(operator, sources, [output], **attributes))

    convolve("picture", "same", (3, 3), (3, 3), pads=[1, 1, 1, 1])
    apply("Add", ["same", "picture"], "brighter")
    apply("Relu", ["brighter"], "positive")
    convolve("positive", "half", (20, 3), (3, 3), pads=[1, 1, 1, 1], strides=[2, 2])
    apply("Relu", ["half"], "skip")
    apply("MaxPool", ["skip"], "low", kernel_shape=[2, 1], strides=[2, 1])
    convolve("low", "far", (20, 20), (1, 5), pads=[0, 4, 0, 4], dilations=[1, 2])
    apply("Relu", ["far"], "seen")
    convolve("seen", "change", (20, 20), (3, 3), pads=[1, 1, 1, 1])
    apply("Add", ["seen", "change"], "deep")
    apply("Relu", ["deep"], "rectified")
    weights["factors"] = np.array([1.0, 1.0, 2.0, 1.0])
    weights["region"] = np.zeros(0)
    apply("Resize", ["rectified", "region", "factors"], "large", mode="linear",
          coordinate_transformation_mode="half_pixel")
    apply("Add", ["large", "skip"], "joined")
    convolve("joined", "last", (20, 20), (1, 1))
    apply("Add", ["last", "joined"], "twice")
    apply("Add", ["twice", "joined"], "thrice")
    convolve("thrice", "logits", (5, 20), (1, 1))
    save(folder, "layers", nodes, weights, (16, 24), [1, 5, 8, 12])


if __name__ == "__main__":
    main()
