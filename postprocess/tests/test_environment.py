"""Environments are what gymnasium expects, the same one by one and all at once."""

from __future__ import annotations

import threading
import time
import warnings

import numpy as np
import pytest

import alewife

pytest.importorskip("alewife_session")
gymnasium = pytest.importorskip("gymnasium")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode, SyncVectorEnv  # noqa: E402

from alewife.environment import Environment, Environments  # noqa: E402

SHORT = alewife.load("eel-to-target").set("time.unsteady.end", 0.5)
N = 3

SMALL = {
    "time.unsteady": {"step": 0.05, "end": 0.1},
    "environment.interval": 0.05,
    "mesh": {"size": 1.6, "surface": 0.2},
    "domain.box": {"min": [-5.0, -2.0], "max": [4.5, 2.0]},
    "environment.target.x": {"uniform": [3.0, 3.5]},
}


def actions(seed: int, n: int = 12) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (n, N, 5)).astype(np.float32)


def test_the_checker_of_gymnasium_finds_nothing() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # Velocities have no bounds
        warnings.filterwarnings("ignore", message=".*infinity")
        check_env(Environment(SHORT), skip_render_check=True)
    made = gymnasium.make("alewife/Swim-v0", case=SHORT)
    check_env(made.unwrapped, skip_render_check=True)


def test_the_checker_of_stable_baselines_finds_nothing() -> None:
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(Environment(SHORT))


def test_an_environment_says_what_it_is() -> None:
    env = Environment(SHORT)
    assert len(env.observations) == 22
    assert env.observation_space.shape == (22,)
    assert env.action_space.shape == (5,)
    assert env.actions["eel.joint.3"] == pytest.approx((-np.deg2rad(40), np.deg2rad(40)))
    assert (env.n_decisions, env.interval) == (5, 0.1)
    _, info = env.reset(seed=3)
    assert info["reason"] == ""
    assert set(info["targets"]) == {"x", "y"}
    *_, truncated, info = env.step(np.full(5, 0.5))
    assert not truncated
    assert info["time"] == 0.1
    assert info["terms"]["effort"] == -0.5
    for _ in range(4):
        *_, truncated, info = env.step(np.zeros(5))
    assert truncated
    assert info["reason"] == "end of the case"
    with pytest.raises(alewife.BadCaseError, match="reset it"):
        env.step(np.zeros(5))


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_all_at_once_are_as_one_by_one(mode: AutoresetMode) -> None:
    ours = Environments(SHORT, N, autoreset_mode=mode)
    theirs = SyncVectorEnv([lambda: Environment(SHORT)] * N, autoreset_mode=mode)
    assert ours.metadata["autoreset_mode"] == mode
    for space in ("action", "observation", "single_action", "single_observation"):
        name = f"{space}_space"
        assert getattr(ours, name) == getattr(theirs, name)
    (seen, _), (wanted, _) = ours.reset(seed=5), theirs.reset(seed=5)
    np.testing.assert_array_equal(seen, wanted)
    for action in actions(1):
        *seen, infos = ours.step(action)
        *wanted, others = theirs.step(action)
        for one, other in zip(seen, wanted, strict=True):
            np.testing.assert_array_equal(one, other)
        np.testing.assert_array_equal(infos["time"], others["time"])
        np.testing.assert_array_equal(infos["targets"]["x"], others["targets"]["x"])
        assert ("final_obs" in infos) == ("final_obs" in others)
        if "final_obs" in infos:
            np.testing.assert_array_equal(infos["_final_obs"], others["_final_obs"])
            np.testing.assert_array_equal(infos["final_obs"], np.stack(others["final_obs"]))
            last, final = infos["final_info"], others["final_info"]
            np.testing.assert_array_equal(last["time"], final["time"])
            np.testing.assert_array_equal(last["terms"]["distance"], final["terms"]["distance"])
        if mode == AutoresetMode.DISABLED and seen[3].any():
            mask = np.array([True, False, True])
            one, _ = ours.reset(options={"reset_mask": mask})
            other, _ = theirs.reset(options={"reset_mask": mask})
            np.testing.assert_array_equal(one, other)
            with pytest.raises(alewife.BadCaseError, match="environment 1 is over"):
                ours.step(action)
            break


def test_threads_change_no_bit() -> None:
    runs = []
    for threads in (1, 2):
        env = Environments(SHORT, N, threads=threads)
        env.reset(seed=1)
        runs.append([env.step(action)[:2] for action in actions(2)])
    for one, other in zip(*runs, strict=True):
        np.testing.assert_array_equal(one[0], other[0])
        np.testing.assert_array_equal(one[1], other[1])


def test_what_cannot_be_is_refused() -> None:
    env = Environments(SHORT, N)
    env.reset()
    action = np.zeros((N, 5))
    action[2, 3] = np.nan
    with pytest.raises(ValueError, match=r"environment 2: the action of `eel.joint.4` is NaN"):
        env.step(action)
    with pytest.raises(ValueError, match="numbers for the actions"):
        env.step(np.zeros(4))
    with pytest.raises(ValueError, match="reset_mask"):
        env.reset(options={"reset_mask": np.zeros(N, bool)})
    with pytest.raises(alewife.BadCaseError, match=r"no \[environment\]"):
        Environment("robot-eel")
    wrong = SHORT.set("environment.interval", 0.025)
    with pytest.raises(alewife.BadCaseError, match=r"interval of 0.025 is 2.5 steps"):
        Environments(wrong, N)
    with pytest.raises(ValueError, match="ale"):
        Environment(SHORT, fidelity="soft")


def test_other_threads_go_on() -> None:
    env = Environments(alewife.load("eel-to-target").set("environment.interval", 2.0), 200)
    env.reset()
    worker = threading.Thread(target=env.step, args=(np.zeros((200, 5)),))
    worker.start()
    ticks = 0
    while worker.is_alive():
        ticks += 1
        time.sleep(0.001)
    assert ticks > 5


def test_the_full_solver_takes_the_same_actions() -> None:
    env = Environment(SHORT.set(SMALL), fidelity="ale")
    first, info = env.reset(seed=2)
    seen, reward, terminated, truncated, _ = env.step(np.full(5, 0.4))
    other = Environment(SHORT.set(SMALL))
    start, told = other.reset(seed=2)
    np.testing.assert_allclose(first, start, atol=1e-6)
    assert info["targets"] == told["targets"]
    np.testing.assert_allclose(seen[:5], other.step(np.full(5, 0.4))[0][:5], atol=1e-6)
    assert np.isfinite(reward)
    assert not terminated
    assert not truncated
