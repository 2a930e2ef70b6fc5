#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Tests tools/train: its classes are the program's, its written-out gradient is the true one. And that
tools can be run directly, and refuse what they cannot do before they begin."""

import multiprocessing
import os
import pathlib
import re
import shutil
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


def run(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=120)


def train_tool(name, *arguments):
    return run(sys.executable, SOURCE / "tools/train" / name, *arguments)


class ToolsTest(unittest.TestCase):
    def test_what_names_its_interpreter_can_be_run(self):
        files = [SOURCE / name for name in ("demo", "test", ".ci/run")]
        files += [path for path in (SOURCE / "tools").rglob("*") if path.is_file()]
        scripts = [path for path in files if path.read_bytes()[:2] == b"#!"]
        self.assertIn(SOURCE / "tools/train/train.py", scripts)
        self.assertEqual([str(path) for path in scripts if not os.access(path, os.X_OK)], [])

    def test_check_format_needs_gits_list(self):
        with tempfile.TemporaryDirectory() as folder:
            tools = pathlib.Path(folder) / "tools"
            tools.mkdir()
            shutil.copy(SOURCE / "tools/check_format.sh", tools)
            for arguments in ([], ["--fix"]):
                result = run(tools / "check_format.sh", *arguments)
                self.assertEqual(result.returncode, 1)
                self.assertIn("git lists no files", result.stderr)

    def test_install_deps_tells_its_arguments(self):
        tool = SOURCE / "tools/install_deps.sh"
        for arguments in (["--list", "--ci"], ["--ci", "--list"]):
            self.assertIn("clang-format", run(tool, *arguments).stdout.split())
        self.assertNotIn("clang-format", run(tool, "--list").stdout.split())
        self.assertIn("usage:", run(tool, "--help").stdout)
        result = run(tool, "--list", "--all")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--all", result.stderr)
        self.assertIn("usage:", result.stderr)
        self.assertEqual(result.stdout, "")

    def test_make_data_counts_failures(self):
        with tempfile.TemporaryDirectory() as folder:
            result = train_tool("make_data.py", "--program", "false", "--out", folder, "--garages", "5-6")
            self.assertEqual(result.returncode, 1)
            self.assertIn("garage 6: exit code 1", result.stdout)
            self.assertIn("2 of the garages failed", result.stderr)
            result = train_tool("make_data.py", "--program", "true", "--out", folder, "--garages", "5-6")
            self.assertEqual(result.returncode, 0, result.stderr)
            for garages in ("5", "6-5", "a-b", "5000-5001"):
                result = train_tool("make_data.py", "--program", "true", "--out", folder, "--garages", garages)
                self.assertEqual(result.returncode, 2)
                self.assertIn("error: ", result.stderr)
            result = train_tool("make_data.py", "--program", f"{folder}/none", "--out", folder)
            self.assertEqual(result.returncode, 2)
            self.assertIn("no such program", result.stderr)


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

    def test_each_network_is_its_own(self):
        """Those that come with Parkade fit into theirs, smaller ones into larger ones only; so do states of when
        two had one name."""
        from network import make_network, name_of
        from text_network import TextNetwork
        from warm_start import load, stored_weights

        models = {"bev-deep": ("bev_segmentation.onnx", 15), "raw-deep": ("view_segmentation.onnx", 7)}
        for name, (model, classes) in models.items():
            network = make_network(name, classes)
            network.load_state_dict(load(str(SOURCE / "models" / model), network))
        reader = str(SOURCE / "models/zone_text.onnx")
        from text_network import name_of as text_name_of
        self.assertEqual(text_name_of(stored_weights(reader)), "text-wide")
        network = TextNetwork("text-wide")
        network.load_state_dict(load(reader, network))
        with self.assertRaisesRegex(SystemExit, "another network"):
            load(reader, TextNetwork("text"))
        sizes = {}
        with tempfile.TemporaryDirectory() as folder:
            for name in ("bev", "bev-deep"):
                network = make_network(name, 15)
                sizes[name] = sum(p.numel() for p in network.parameters())
                for said in {name, "bev"}:
                    self.assertEqual(name_of({"name": said, "average": network.state_dict()}), name)
                torch.save({"average": network.state_dict()}, f"{folder}/{name}.pt")
            self.assertAlmostEqual(sizes["bev"] / 1e6, 0.63, delta=0.01)
            self.assertAlmostEqual(sizes["bev-deep"] / 1e6, 1.35, delta=0.01)
            deep, plain = make_network("bev-deep", 15), make_network("bev", 15)
            deep.load_state_dict(load(f"{folder}/bev.pt", deep))
            for path in (f"{folder}/bev-deep.pt", str(SOURCE / "models/bev_segmentation.onnx")):
                with self.assertRaisesRegex(SystemExit, "another network"):
                    load(path, plain)
            deep_run = pathlib.Path(folder) / "run"
            deep_run.mkdir()
            torch.save({"name": "bev", "average": deep.state_dict()}, deep_run / "state.pt")
            data = pathlib.Path(folder) / "g0001"
            data.mkdir()
            (data / "0_bev_labels.png").touch()
            result = train_tool("train.py", "--data", folder, "--network", "bev", "--out", deep_run)
            self.assertEqual(result.returncode, 2)
            self.assertIn("is of bev-deep", result.stderr)

    def test_blends_lie_between(self):
        from network import make_network
        from text_network import TextNetwork
        from warm_start import stored_weights

        torch.manual_seed(6)
        with tempfile.TemporaryDirectory() as folder:
            for make, said in ((lambda: make_network("raw-deep", 7), {"name": "raw-deep"}),
                               (lambda: TextNetwork("text"), {})):
                paths = [f"{folder}/{k}.pt" for k in range(3)]
                for path in paths[:2]:
                    torch.save({"average": make().state_dict(), "step": 1}, path)
                for share in ("0", "1", "0.25"):
                    result = train_tool("blend.py", *paths[:2], "--share", share, "--out", paths[2])
                    self.assertEqual(result.returncode, 0, result.stderr)
                    key = next(key for key, value in make().state_dict().items() if value.dim() == 4)
                    a, b, blend = (stored_weights(path)[key] for path in paths)
                    wanted = a + float(share) * (b - a)
                    # Batch norms that did nothing yet are folded into it, but for their epsilon.
                    self.assertLess(float((blend - wanted).abs().max()), 1e-4)
                state = torch.load(paths[2])
                self.assertEqual({key: state.get(key) for key in said}, said)

    def test_training_tells_missing_samples(self):
        with tempfile.TemporaryDirectory() as folder:
            empty, out = pathlib.Path(folder), pathlib.Path(folder) / "out"
            (empty / "g0013").mkdir()
            (empty / "g0013/0_bev_labels.png").touch()  # for validation
            for data in (empty, empty / "none"):
                for tool, more in (("train.py", ["--network", "bev"]), ("train_text.py", [])):
                    result = train_tool(tool, "--data", data, "--out", out, *more)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertIn(f"--data {data}", result.stderr)
                    self.assertFalse(out.exists())
            result = train_tool("train_text.py")
            self.assertEqual(result.returncode, 2)
            self.assertIn("--out", result.stderr)

    def test_loss_on_a_device_is_the_processors(self):
        from train import SegmentationLoss
        from train_device import segmentation_loss

        torch.manual_seed(3)
        rows = torch.randn(2, 5, 1, 2, 16, 16)
        logits = rows.expand(2, 5, 2, 2, 16, 16).reshape(2, 20, 16, 16).contiguous()
        labels = torch.randint(0, 5, (2, 16, 32)).repeat_interleave(2, 1)
        labels[0, :8] = 255
        weight = torch.rand(5) + 0.5
        expected = SegmentationLoss.apply(logits, labels.byte(), weight, 0)
        self.assertAlmostEqual(float(segmentation_loss(logits, labels, weight)), float(expected), places=2)

    def test_labels_move_with_the_picture(self):
        from batch_augment import augment, transform
        from classes import IGNORE

        torch.manual_seed(4)
        labels = torch.zeros(16, 64, 64).byte()
        labels[:, 10:30, 5:25], labels[:, 35:60, 40:56] = 1, 2
        images = 100.0 * labels[:, None].float().expand(-1, 3, -1, -1)
        for views in (False, True):
            moved, told = transform(images, labels, IGNORE, 0.5, views)
            self.assertGreater(int((told == 1).sum()), 1000)
            self.assertGreater(int((told == IGNORE).sum()), 100)
            inner = (F.max_pool2d(told[:, None].float(), 9, 1, 4)
                     == -F.max_pool2d(-told[:, None].float(), 9, 1, 4))[:, 0] & (told != IGNORE)
            middle = (slice(None), slice(5, -5), slice(5, -5))  # what is next to its edge is not known
            apart = (moved[:, 0] - 100.0 * told).abs()[middle][inner[middle]]
            self.assertGreater(len(apart), 10000)
            self.assertLess(float(apart.max()), 1e-2)
        same = augment(moved, told, 0, 1, plain=1.0)
        self.assertTrue(bool((same[moved.sum(1, keepdim=True).expand(-1, 3, -1, -1) < 1] == 0).all()))
        changed = augment(moved, told, 0, 1, plain=0.0)
        self.assertEqual(changed.shape, moved.shape)
        self.assertTrue(bool(((changed >= 0) & (changed <= 255)).all()))

    def test_what_real_places_look_like(self):
        from batch_augment import Draw, cameras, plates, shade

        torch.manual_seed(5)
        images = torch.full((16, 3, 96, 96), 120.0)
        labels = torch.zeros(16, 96, 96).byte()
        labels[:, :, 48:] = 1
        draw = Draw(16, "cpu")
        covered = plates(draw, images, labels, 1)
        self.assertTrue(bool((covered[:, :, :, :48] == 120.0).all()))  # no floor
        self.assertGreater(int((covered[:, :, :, 48:] != 120.0).sum()), 100)
        dark = shade(draw, images)
        self.assertLess(float(dark.max()), 130.0)
        self.assertGreater(float(dark.min()), 20.0)
        self.assertGreater(float((dark.amax((1, 2, 3)) - dark.amin((1, 2, 3))).median()), 10.0)
        apart = cameras(draw, images)
        self.assertTrue(bool(torch.isfinite(apart).all()))
        self.assertGreater(float((apart[:, :, 0, 48] - apart[:, :, 95, 48]).abs().median()), 5.0)

    def test_training_on_a_device_takes_in_what_is_drawn(self):
        from PIL import Image

        rng = np.random.default_rng(5)
        with tempfile.TemporaryDirectory() as folder:
            for seed in (1, 3):
                garage = pathlib.Path(folder) / f"g{seed:04d}"
                garage.mkdir()
                for view in range(4):
                    Image.fromarray(rng.integers(0, 255, (192, 320, 3)).astype(np.uint8)).save(
                        garage / f"000_raw{view}.jpg")
                    Image.fromarray(rng.integers(14, 16, (192, 320)).astype(np.uint8)).save(
                        garage / f"000_raw{view}_labels.png")
                (garage / "done").touch()
            out = pathlib.Path(folder) / "out"
            result = train_tool("train_device.py", "--data", folder, "--network", "raw", "--out", out,
                                "--minutes", "0.01", "--device", "cpu", "--batch", "2", "--begin-with", "4",
                                "--readers", "1")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("4 pictures  mean IoU", result.stdout)
            state = torch.load(out / "raw.pt")
            self.assertEqual(state["name"], "raw")
            self.assertGreater(state["step"], 0)
            result = train_tool("train_device.py", "--data", f"{folder}/none", "--network", "raw", "--out", out,
                                "--device", "cpu")
            self.assertEqual(result.returncode, 2)
            self.assertIn("no such folder", result.stderr)

    def test_training_ends_with_the_process_that_makes_batches(self):
        from train import next_batch

        batches = multiprocessing.Queue(4)
        maker = multiprocessing.Process(target=batches.put, args=("a batch",))
        maker.start()
        self.assertEqual(next_batch(batches, maker), "a batch")
        maker.join()
        with self.assertRaisesRegex(SystemExit, "has ended"):
            next_batch(batches, maker, 0.01)

    def test_export_replaces_a_model_only_by_one_that_was_compared(self):
        from text_network import TextNetwork

        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            torch.save({"average": TextNetwork().state_dict()}, folder / "text.pt")
            model, description = folder / "reader.onnx", folder / "reader.yaml"
            model.write_text("the one before")
            names = sorted(os.listdir(folder))

            def export(check):
                return train_tool("export_text.py", folder / "text.pt", "--out", folder / "reader",
                                  "--check", check)

            result = export(folder / "none")
            self.assertEqual(result.returncode, 2)
            self.assertIn("no such program", result.stderr)
            self.assertEqual(export("false").returncode, 1)
            self.assertEqual(sorted(os.listdir(folder)), names)
            self.assertEqual(model.read_text(), "the one before")
            result = export("none")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(model.stat().st_size, 100000)
            self.assertIn("network: reader.onnx\n", description.read_text())
            self.assertEqual(sorted(os.listdir(folder)), ["reader.onnx", "reader.yaml", "text.pt"])

    def test_exported_kernels_have_eight_significant_bits(self):
        from export import rounded
        from network import make_network

        network = make_network("bev-deep", 15)
        before = {name: value.clone() for name, value in network.state_dict().items()}
        for name, value in rounded(network).state_dict().items():
            if value.dim() < 2:
                self.assertTrue(torch.equal(value, before[name]), name)
                continue
            self.assertTrue(bool((torch.abs(value - before[name]) <= 2.0 ** -8 * before[name].abs()).all()), name)
            self.assertFalse(bool((value.contiguous().view(torch.int32) & 0xFFFF).any()), name)

    def test_warm_start_from_an_exported_network(self):
        """What is loaded computes what the file computes, before batch norms settle and after."""
        import numpy as np
        import onnx
        from network import fold_batch_norm, make_network, to_input
        from warm_start import load, settle

        model = str(SOURCE / "models" / "view_segmentation.onnx")
        rng = np.random.default_rng(3)
        pictures = to_input(rng.integers(0, 255, (4, 192, 320, 3)).astype(np.uint8))
        network = make_network("raw-deep", 7)
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
