"""Decisions a second of many environments from Python, beside those of `environments.rs`."""

import sys
import time

import numpy as np

from alewife.environment import Environments

DECISIONS = 40

n = int(sys.argv[1]) if len(sys.argv) > 1 else 2048
envs = Environments("eel-to-target", n, threads=1)
envs.reset(seed=1)
actions = np.random.default_rng(1).uniform(-1, 1, (n, 5)).astype(np.float32)
envs.step(actions)
start = time.perf_counter()
for _ in range(DECISIONS):
    envs.step(actions)
seconds = time.perf_counter() - start
steps = DECISIONS * n * round(envs.interval / 0.01) / seconds
print(f"{n} environments: {DECISIONS * n / seconds:.0f} decisions/s, {steps:.0f} steps/s")
