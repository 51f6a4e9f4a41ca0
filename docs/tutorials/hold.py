"""Flies an underwater vehicle by a tuned controller: it holds a velocity, or follows a line.

`python hold.py hold 100` holds velocities that are asked for, over ballasts and drags it was not
tuned by; `python hold.py line 20` follows lines by line-of-sight guidance. Both say how well that
is done: what a learned policy is to be better than.
"""

import sys

import numpy as np

from alewife.environment import Environment

UNSEEN = 1_000_000  # Seeds from here on are of targets to try it on
INTERVAL = 0.1  # s
COMMANDS = np.linspace(0.0, 0.9, 200)
POWERS = np.array([1, 3, 5, 7, 9])
FORCES = (COMMANDS[:, None] ** POWERS) @ np.array([8.9, 176.0, -404.1, 389.9, -140.3])  # N

# Of each thruster, in the order of the actions: forces along x, y, z and torques about them
HALF = np.sqrt(0.5)
MIX = np.array(
    [
        [HALF, HALF, HALF, HALF, 0, 0, 0, 0],
        [-HALF, HALF, HALF, -HALF, 0, 0, 0, 0],
        [0, 0, 0, 0, 1, 1, 1, 1],
        [0, 0, 0, 0, 0.218, -0.218, 0.218, -0.218],
        [0, 0, 0, 0, -0.12, -0.12, 0.12, 0.12],
        0.267 * HALF * np.array([-1, 1, -1, 1, 0, 0, 0, 0]),
    ]
)
SHARES = np.linalg.pinv(MIX)


class Pid:
    """Proportional and integral in velocities, proportional and differential in angles."""

    def __init__(self) -> None:
        """Begin with nothing summed up."""
        self.sums = np.zeros(3)

    def actions(self, lacks: np.ndarray, angles: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Say what the thrusters do about velocities (m/s) and angles (rad) that lack."""
        self.sums = np.clip(self.sums + INTERVAL * lacks, -1.5, 1.5)
        forces = 60.0 * lacks + 60.0 * self.sums
        torques = 8.0 * angles - 2.5 * rates
        wanted = SHARES @ np.concatenate([forces, torques])
        return np.sign(wanted) * np.interp(np.abs(wanted), FORCES, COMMANDS)


def asked(task: str, pid: Pid, seen: np.ndarray) -> np.ndarray:
    """Turn observations of a task into actions."""
    _, v, w, roll, pitch, *rates = seen[:8]
    if task == "hold":
        heading, lacks = -seen[8], seen[9:12]
    else:
        # The heading of the line of sight; depth by a velocity towards it
        heading, lacks = seen[9], np.array([seen[10], -v, -0.5 * seen[11] - w])
    return pid.actions(lacks, np.array([-roll, -pitch, heading]), np.array(rates))


def fly(task: str, n: int) -> None:
    """Say how far it is off at the ends of so many episodes, at most and in the mean."""
    env = Environment(f"underwater-vehicle/{task}")
    off, returns = [], []
    for seed in range(UNSEEN, UNSEEN + n):
        seen, _ = env.reset(seed=seed)
        pid, paid, over = Pid(), 0.0, False
        while not over:
            seen, reward, terminated, truncated, info = env.step(asked(task, pid, seen))
            over, paid = terminated or truncated, paid + reward
        velocities = np.linalg.norm(seen[9:12])
        off.append(velocities if task == "hold" else abs(seen[8]))
        returns.append(paid)
        if terminated:
            print(seed, info["reason"])
    what = "velocity (m/s)" if task == "hold" else "distance from the line (m)"
    print(f"{what} that lacks: {np.mean(off):.4f} in the mean, {np.max(off):.4f} at most")
    print(
        f"reward of an episode: {np.mean(returns):.1f} in the mean, {np.min(returns):.1f} at least"
    )


if __name__ == "__main__":
    what, *rest = sys.argv[1:] or ["hold"]
    fly(what, int(*rest or [20]))
