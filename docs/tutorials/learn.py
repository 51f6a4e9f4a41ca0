"""Trains a policy that steers the eel to a target, and tries it on targets it has not seen.

`python learn.py train 200000` learns by the reduced model with PPO of stable-baselines3 and writes
`eel.zip`; `python learn.py try 100` tries it by the reduced model, `python learn.py try 10 ale` by
the full solver, minutes each. The servos beat in a wave, to which the policy adds its actions.
"""

import sys

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecEnv, VecMonitor

from alewife.environment import Environment, Environments

CASE = "eel-to-target"
UNSEEN = 1_000_000  # Seeds from here on are of targets to try it on
AMPLITUDES = np.array([0.29, 0.43, 0.50, 0.57, 0.64])
PHASES = np.array([0.0, 0.83, 0.17, 0.0, 0.83])
SHARE = 0.5  # Of the policy beside the wave


def asked(actions: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Give the wave that is due at the end of the next interval, and what the policy adds to it."""
    phases = np.asarray(times)[..., None] + 0.1 + PHASES
    return AMPLITUDES * np.sin(2 * np.pi * phases) + SHARE * actions


class Many(VecEnv):
    """Environments as stable-baselines3 has them: they start again in the step that ends them."""

    def __init__(self, n: int, threads: int) -> None:
        self.envs = Environments(CASE, n, threads=threads, autoreset_mode="SameStep")
        super().__init__(n, self.envs.single_observation_space, self.envs.single_action_space)

    def reset(self):
        seen, infos = self.envs.reset(seed=0)
        self.times = infos["time"]
        return seen.copy()

    def step_async(self, actions):
        self.actions = asked(actions, self.times)

    def step_wait(self):
        seen, rewards, terminated, truncated, infos = self.envs.step(self.actions)
        self.times = infos["time"]
        told = [{} for _ in range(self.num_envs)]
        for nth in np.flatnonzero(terminated | truncated):
            told[nth] = {
                "terminal_observation": infos["final_obs"][nth],
                "TimeLimit.truncated": bool(truncated[nth]),
            }
        return seen.copy(), rewards.copy(), terminated | truncated, told

    def close(self):
        self.envs.close()

    def get_attr(self, name, indices=None):
        return [getattr(self.envs, name, None)] * self.num_envs

    def set_attr(self, name, value, indices=None):
        raise NotImplementedError

    def env_method(self, name, *arguments, indices=None, **named):
        raise NotImplementedError

    def env_is_wrapped(self, wrapper_class, indices=None):
        return [False] * self.num_envs


def train(n_steps: int, seed: int) -> None:
    """Learn for so many decisions."""
    torch.set_num_threads(1)
    env = VecMonitor(Many(64, threads=1))
    policy = PPO(
        "MlpPolicy",
        env,
        n_steps=128,
        batch_size=1024,
        gamma=0.98,
        learning_rate=1e-3,
        policy_kwargs={"log_std_init": -1.0},
        seed=seed,
        verbose=1,
    )
    policy.learn(n_steps)
    policy.save("eel")


def try_on(n: int, fidelity: str) -> None:
    """Say how many of so many targets are reached, and when."""
    policy, env = PPO.load("eel"), Environment(CASE, fidelity=fidelity)
    reached, times = 0, []
    for seed in range(UNSEEN, UNSEEN + n):
        seen, info = env.reset(seed=seed)
        over = False
        while not over:
            action, _ = policy.predict(seen, deterministic=True)
            seen, _, terminated, truncated, info = env.step(asked(action, info["time"]))
            over = terminated or truncated
        reached += terminated
        times.append(info["time"])
        print(seed, info["targets"], info["reason"], f"{info['time']:.1f}", info["message"])
    print(f"{fidelity}: {reached} of {n} targets, after {np.mean(times):.1f} in the mean")


if __name__ == "__main__":
    what, number, *rest = sys.argv[1:]
    if what == "train":
        train(int(number), *(int(seed) for seed in rest or [0]))
    else:
        try_on(int(number), *(rest or ["reduced"]))
