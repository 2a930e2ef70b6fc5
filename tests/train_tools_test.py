#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Tests tools/train: its classes are the program's, its written-out gradient is the true one."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SOURCE / "tools" / "train"))

try:
    import numpy as np
except ImportError:
    np = None
try:
    import torch
    from torch.nn import functional as F
except ImportError:
    torch = None


class ClassesTest(unittest.TestCase):
    def test_classes_are_those_of_the_program(self):
        from classes import SEMANTIC_CLASSES, NETWORKS, label_table

        text = (SOURCE / "src/parkade/types/semantic_class.hpp").read_text(encoding="utf-8")
        names = re.findall(r'"([a-z_]+)"', text[text.index("kSemanticClassNames =") :])
        self.assertEqual(SEMANTIC_CLASSES, names)
        for network, spec in NETWORKS.items():
            table = label_table(network)
            for name in spec["classes"]:
                value = SEMANTIC_CLASSES.index(name)
                self.assertEqual(table[value], spec["classes"].index(name))
            self.assertEqual(table[255], 255)
        bev = NETWORKS["bev"]["classes"]
        marker = SEMANTIC_CLASSES.index("zone_marker")
        self.assertEqual(label_table("bev")[marker], bev.index("pillar"))


@unittest.skipIf(np is None, "python3-numpy is not installed")
class SlotWeightsTest(unittest.TestCase):
    def run_tool(self, text):
        with tempfile.TemporaryDirectory() as folder:
            trials = pathlib.Path(folder) / "slot_trials.csv"
            trials.write_text(text)
            out = pathlib.Path(folder) / "weights.hpp"
            result = subprocess.run([sys.executable, SOURCE / "tools/train/slot_weights.py", trials, "--out", out],
                                    capture_output=True, text=True)
            return result, out.read_text() if out.exists() else ""

    def test_weights_follow_the_candidates(self):
        rows = []
        for i in range(400):
            right = i % 2
            rows.append(f"{i % 10},{right},{0 if right else 3},{0.9 if right else 0.2},0.5,0")
        result, text = self.run_tool("garage,right,doubt,seen,way_floor,parallel\n" + "\n".join(rows))
        self.assertEqual(result.returncode, 0, result.stderr)
        weights = {name: float(value) for value, name in re.findall(r"(-?[0-9.]+), *// (\w+)", text)}
        self.assertEqual(list(weights), ["seen", "way_floor", "parallel"])
        self.assertGreater(weights["seen"], 1.5)
        self.assertGreater(float(re.search(r"kSlotDoubtWeight = (\S+);", text)[1]), 0.5)

    def test_other_files_are_refused(self):
        for text, message in (("", "no slot_trials.csv"), ("a,b\n1,2\n", "no slot_trials.csv"),
                              ("garage,right,doubt,parallel\n", "no candidates"),
                              ("garage,right,doubt,parallel\n1,1,0,x\n", "could not convert")):
            result, written = self.run_tool(text)
            self.assertEqual(result.returncode, 1)
            self.assertIn(message, result.stderr)
            self.assertEqual(written, "")

    def test_weights_are_of_the_programs_clues(self):
        folder = SOURCE / "src/parkade/semantics/slots"
        text = (folder / "slot_clues.hpp").read_text(encoding="utf-8")
        text = text[text.index("kSlotClueNames =") :]
        names = re.findall(r'"([a-z_]+)"', text[: text.index(";")])
        self.assertEqual(re.findall(r"// (\w+)$", (folder / "slot_weights.hpp").read_text(), re.M), names)


@unittest.skipIf(torch is None, "python3-torch is not installed")
class LossTest(unittest.TestCase):
    def reference(self, logits, labels, weight, row):
        """The same by automatic differentiation, on the rows that count."""
        from classes import IGNORE

        logits = F.pixel_shuffle(logits, 2)[:, :, row::2]
        labels = labels.long()[:, row::2]
        entropy = F.cross_entropy(logits, labels, weight=weight, ignore_index=IGNORE)
        known = labels != IGNORE
        p = torch.softmax(logits, 1)
        target = torch.where(known, labels, torch.zeros_like(labels))
        hit = torch.gather(p, 1, target[:, None])[:, 0] * known
        n = logits.shape[1]
        overlap = torch.zeros(n).scatter_add(0, target.flatten(), hit.flatten())
        truth = torch.zeros(n).scatter_add(0, target.flatten(), known.flatten().float())
        mass = (p * known[:, None]).sum((0, 2, 3))
        dice = 1.0 - (2.0 * overlap + 1.0) / (truth + mass + 1.0)
        return entropy + 0.7 * dice[truth > 20].mean()

    def test_gradient(self):
        from train import SegmentationLoss

        torch.manual_seed(1)
        logits = torch.randn(2, 20, 16, 16, requires_grad=True)
        labels = torch.randint(0, 5, (2, 32, 32)).byte()
        labels[0, :7] = 255
        weight = torch.rand(5) + 0.5
        for row in (0, 1):
            expected = self.reference(logits, labels, weight, row)
            (slope,) = torch.autograd.grad(expected, logits)
            found = SegmentationLoss.apply(logits, labels, weight, row)
            (found_slope,) = torch.autograd.grad(found, logits)
            self.assertAlmostEqual(float(expected), float(found), places=5)
            self.assertGreater(float(slope.abs().max()), 1e-4)
            self.assertLess(float((slope - found_slope).abs().max()), 1e-7)

    def test_folding_batch_norm_changes_nothing(self):
        from network import fold_batch_norm, make_network

        torch.manual_seed(2)
        network = make_network("raw", 7)
        picture = torch.randn(2, 3, 64, 96)
        with torch.no_grad():
            for _ in range(3):
                network(picture)  # gathers statistics
            network.eval()
            before = network(picture)
            after = fold_batch_norm(network)(picture)
        self.assertEqual(list(before.shape), [2, 28, 32, 48])
        self.assertLess(float((before - after).abs().max()), 1e-4)

    def test_warm_start_from_an_exported_network(self):
        """What is loaded computes what the file computes, before batch norms settle and after."""
        import numpy as np
        import onnx
        from network import fold_batch_norm, make_network, to_input
        from warm_start import load, settle

        model = str(SOURCE / "models" / "view_segmentation.onnx")
        rng = np.random.default_rng(3)
        pictures = to_input(rng.integers(0, 255, (4, 96, 160, 3)).astype(np.uint8))
        network = make_network("raw", 7)
        network.load_state_dict(load(model, network))
        with torch.no_grad():
            before = network.eval()(pictures)
            settle(network, [pictures])
            in_training = network.train()(pictures)
            settled = network.eval()(pictures)
        self.assertGreater(float(before.std()), 0.5)
        tolerance = 1e-3 * float(before.abs().max())
        self.assertLess(float((settled - before).abs().max()), tolerance)
        # The same batch that the batch norms settled on: training sees the very same numbers.
        self.assertLess(float((in_training - before).abs().max()), tolerance)
        weights = fold_batch_norm(network).state_dict()
        for value in onnx.load(model).graph.initializer:
            stored = torch.from_numpy(onnx.numpy_helper.to_array(value).copy())
            self.assertLess(float((weights[value.name] - stored).abs().max()),
                            1e-3 * float(stored.abs().max()), value.name)
        with self.assertRaises(SystemExit):
            load(str(SOURCE / "models" / "zone_text.onnx"), network)


if __name__ == "__main__":
    unittest.main()
