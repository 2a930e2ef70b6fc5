# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""What the trainings on a graphics processor share: how long they go on, and how."""
import os
import time

import numpy as np
import torch

from train import save


class Clock:
    """How much of the time is spent, which a file beside the results may change."""

    def __init__(self, minutes, folder):
        self.start, self.minutes, self.path = time.time(), minutes, os.path.join(folder, "minutes")

    def elapsed(self):
        return time.time() - self.start

    def done(self):
        try:
            with open(self.path) as file:
                self.minutes = float(file.read())
        except (OSError, ValueError):
            pass
        return self.elapsed() / (60.0 * self.minutes)


def rate_at(done, step, highest, warm_up):
    return highest * min(1.0, (step + 1) / warm_up) * (0.5 * (1 + np.cos(np.pi * min(done, 1.0))) + 0.003)


class Mean:
    """Exponential mean of the weights over about so many steps, which is what gets exported."""

    def __init__(self, network, steps):
        self.decay = 1.0 - 1.0 / steps
        now = network.state_dict()
        self.state = {k: v.detach().clone() for k, v in now.items()}
        floats = [k for k, v in now.items() if v.dtype.is_floating_point]
        self.now, self.averages = [now[k] for k in floats], [self.state[k] for k in floats]

    @torch.no_grad()
    def update(self, step):
        decay = min(self.decay, (1 + step) / (10 + step))
        torch._foreach_mul_(self.averages, decay)
        torch._foreach_add_(self.averages, self.now, alpha=1.0 - decay)


def add_learning(parser):
    """The options of every training on a device but for the batch."""
    parser.add_argument("--out", required=True)
    parser.add_argument("--minutes", type=float, default=25.0)
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--device", default="cuda")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--warm-up", type=int, default=300, help="steps until the rate is whole [300]")
    parser.add_argument("--mean-steps", type=int, default=667,
                        help="steps that the exported mean of the weights reaches back [667]")


def check(parser, arguments):
    """Ends the program where it has no device, or no folder to read."""
    if torch.device(arguments.device).type == "cuda" and not torch.cuda.is_available():
        parser.error(f"--device {arguments.device}: torch finds none here (train.py and train_text.py "
                     "learn on the processor; --device cpu tries this program there)")
    for name in ("warm_up", "mean_steps"):
        if getattr(arguments, name) < 1:
            parser.error(f"--{name.replace('_', '-')} {getattr(arguments, name)}: one step at least")
    for folder in arguments.data:
        if not os.path.isdir(folder):
            parser.error(f"--data {folder}: no such folder")


class Step:
    """One step of learning: the loss of a batch, its gradients, and what the optimiser makes of them. loss_of(*batch) is
    recorded once on a graphics processor and replayed with the rest (a CUDA graph): to launch its thousand small
    kernels one by one takes longer than they do. It must not wait for the device, and batches must be alike."""

    def __init__(self, a, network, loss_of, record):
        self.network, self.loss_of, self.graph = network, loss_of, None
        self.record = record and torch.device(a.device).type == "cuda"
        rate = torch.tensor(a.rate, device=a.device) if self.record else a.rate
        self.optimiser = torch.optim.AdamW(network.parameters(), lr=rate, weight_decay=1e-2,
                                           capturable=self.record)

    def _once(self, batch):
        loss = self.loss_of(*batch)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 5.0)
        self.optimiser.step()
        return loss.detach()

    def _record(self, batch):
        self.batch = [part.clone() for part in batch]
        aside = torch.cuda.Stream()
        aside.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(aside):  # what libraries choose and keep at first must not be recorded
            for _ in range(3):
                self.optimiser.zero_grad(set_to_none=True)
                self._once(self.batch)
        torch.cuda.current_stream().wait_stream(aside)
        self.optimiser.zero_grad(set_to_none=True)
        graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(graph):
            self.loss = self._once(self.batch)
        self.graph = graph

    def __call__(self, batch, rate):
        """The loss, on the device."""
        for group in self.optimiser.param_groups:
            if self.record:
                group["lr"].fill_(rate)
            else:
                group["lr"] = rate
        if not self.record:
            self.optimiser.zero_grad(set_to_none=True)
            return self._once(batch)
        if self.graph is None:
            try:
                self._record(batch)
            except RuntimeError as error:
                print(f"cannot be recorded, goes on without: {error}", flush=True)
                self.record = False
                return self(batch, rate)
        for kept, part in zip(self.batch, batch):
            kept.copy_(part)
        self.graph.replay()
        return self.loss.clone()


def learn(a, clock, network, make, next_batch, loss_of, take, judge, path, said_too, record=True):
    """Until the time is spent. make(): a network such as this one on its device; next_batch(): tensors, and
    loss_of(*tensors) the loss of them, recorded if that can be (Step); take(): takes in what was drawn since;
    judge(best, done): what to say of the mean of the weights, which goes to path with what said_too holds."""
    log = open(os.path.splitext(path)[0] + ".txt", "a", buffering=1)
    learn_from = Step(a, network, loss_of, record)
    mean = Mean(network, a.mean_steps)
    step, losses, polled, said, done = 0, [], time.time(), time.time(), 0.0
    while done < 1.0:
        done = clock.done() if step % 20 == 0 else done
        losses.append(learn_from(next_batch(), rate_at(done, step, a.rate, a.warm_up)))
        step += 1
        mean.update(step)
        if time.time() - polled > 10 and done < 0.9:
            polled = time.time()
            take()
        if time.time() - said > 60 or done >= 1.0:
            said = time.time()
            best = make()
            best.load_state_dict(mean.state)
            save(path, {"average": {k: v.cpu() for k, v in mean.state.items()}, "step": step, **said_too})
            text = (f"step {step}  {clock.elapsed():.0f} s  done {done:.2f}  "
                    f"loss {torch.stack(losses).mean():.3f}  {judge(best, done)}")
            log.write(text + "\n")
            print(text, flush=True)
            losses = []
