"""Environments: a case with `[environment]` as a task of gymnasium, one or many at once."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from alewife.case import Case
from alewife.program import AlewifeWarning
from alewife.session import _call, _module

try:
    import gymnasium
    from gymnasium.spaces import Box
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space
except ImportError as error:
    raise ImportError("environments need gymnasium: pip install 'alewife[learning]'") from error

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[Any]

#: Which solver moves the swimmer.
FIDELITIES = ("reduced", "ale")

#: Reasons that every environment has, before its own.
N_ALWAYS = 4


class _Layout:
    """What environments of a case are like: spaces, and names of what they tell."""

    def __init__(self, layout: tuple) -> None:
        """Take over what the extension module says."""
        observations, actions, (targets, terms, reasons), counts, self.interval = layout
        self.n_terminate, self.n_decisions = counts
        self.observations = [name for name, _, _ in observations]
        low = np.array([one for _, one, _ in observations], np.float32)
        high = np.array([one for _, _, one in observations], np.float32)
        self.observation_space = Box(low, high, dtype=np.float32)
        self.actions = {name: (low, high) for name, low, high in actions}
        self.action_space = Box(-1.0, 1.0, (len(actions),), np.float32)
        self.targets, self.terms, self.reasons = targets, terms, reasons


class Environment(gymnasium.Env):
    """A swimmer that is told what to do: `gymnasium.Env` of a case with `[environment]`.

    Actions are numbers from -1 to 1, one a command, to which they are clipped; observations are as
    the case orders them. The info has `time`, `sample`, `targets`, the `terms` of the reward, the
    `reason` for which an episode is over, and the `message` of the solver. Without a seed an
    episode is the next one after that of the last seed, at first after the seed of the case.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012

    def __init__(
        self,
        case: Case | str | Path,
        *,
        fidelity: str = "reduced",
        threads: int = 1,
        render_mode: str | None = None,
    ) -> None:
        """Open a case by its name, or as `alewife.load` gives it; BadCaseError where it is wrong.

        `fidelity` is "reduced" or "ale", the full solver: slow, and right.
        """
        if fidelity not in FIDELITIES:
            raise ValueError(f"{fidelity!r}: {' or '.join(FIDELITIES)} is accepted")
        if render_mode is not None:
            raise ValueError(f"{render_mode!r}: an environment draws nothing, None is accepted")
        name, settings = _written(case)
        is_full = fidelity == "ale"
        inner, odd = _call(_module().Environment.open, name, settings, is_full, threads)
        _warn(odd)
        self._inner = inner
        self._layout = _Layout(inner.layout())
        self.fidelity = fidelity
        self.render_mode = render_mode
        self.observation_space = self._layout.observation_space
        self.action_space = self._layout.action_space

    @property
    def observations(self) -> list[str]:
        """What is observed."""
        return self._layout.observations

    @property
    def actions(self) -> dict[str, tuple[float, float]]:
        """Commands, and what the actions -1 and 1 ask of them."""
        return self._layout.actions

    @property
    def n_decisions(self) -> int:
        """Decisions in an episode, at most."""
        return self._layout.n_decisions

    @property
    def interval(self) -> float:
        """Time between two decisions (s)."""
        return self._layout.interval

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Start an episode: that of a seed, or the next one. There are no options."""
        super().reset(seed=seed)
        observation, told = _call(self._inner.reset, None if seed is None else int(seed))
        return _singles(observation), self._info(told)

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Take an action for an interval; ValueError where it is no number."""
        action = np.asarray(action, np.float64).ravel().tolist()
        observation, reward, terminated, truncated, told = _call(self._inner.step, action)
        return _singles(observation), reward, terminated, truncated, self._info(told)

    def _info(self, told: tuple) -> dict[str, Any]:
        time, sample, targets, terms, reason, message = told
        return {
            "time": time,
            "sample": sample,
            "targets": dict(zip(self._layout.targets, targets, strict=True)),
            "terms": dict(zip(self._layout.terms, terms, strict=True)),
            "reason": reason,
            "message": message,
        }


class Environments(VectorEnv):
    """Many environments of one case by its reduced model: `gymnasium.vector.VectorEnv`.

    They are moved in threads, without the lock of the interpreter, and each is the same whatever
    the others do and however many threads there are. Infos are arrays: `time`, `sample`, `reason`
    (a number, whose text is in `reasons`), `targets` and `terms` by their names. Where an episode
    ends and the next one starts in the same step, `final_obs` has the last observations and
    `final_info` the rest, as gymnasium has them.
    """

    def __init__(
        self,
        case: Case | str | Path,
        num_envs: int = 1,
        *,
        threads: int = 1,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        render_mode: str | None = None,
    ) -> None:
        """Open so many of a case in so many threads."""
        if render_mode is not None:
            raise ValueError(f"{render_mode!r}: an environment draws nothing, None is accepted")
        for what, number in (("num_envs", num_envs), ("threads", threads)):
            if not isinstance(number, int) or number < 1:
                raise ValueError(f"{what} {number!r}: a whole number from 1 on is accepted")
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {"render_modes": [], "autoreset_mode": self.autoreset_mode}
        name, settings = _written(case)
        inner, odd = _call(_module().Batch.open, name, settings, num_envs, threads)
        _warn(odd)
        self._inner = inner
        self._layout = layout = _Layout(inner.layout())
        self.num_envs = num_envs
        self.render_mode = render_mode
        self.single_observation_space = layout.observation_space
        self.single_action_space = layout.action_space
        self.observation_space = batch_space(layout.observation_space, num_envs)
        self.action_space = batch_space(layout.action_space, num_envs)
        self._all = np.ones(num_envs, np.bool_)
        self._shape = (num_envs, len(layout.observations))

    @property
    def reasons(self) -> list[str]:
        """What the numbers of `infos["reason"]` mean; the first one is that an episode goes on."""
        return self._layout.reasons

    @property
    def n_decisions(self) -> int:
        """Decisions in an episode, at most."""
        return self._layout.n_decisions

    @property
    def interval(self) -> float:
        """Time between two decisions (s)."""
        return self._layout.interval

    def reset(
        self,
        *,
        seed: int | Sequence[int] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Array, dict[str, Any]]:
        """Start episodes: by seeds, one each or seed, seed + 1, ..., or as the next ones.

        `options={"reset_mask": mask}` starts those of a mask alone.
        """
        is_one = seed is None or np.ndim(seed) == 0
        super().reset(seed=seed if is_one else None)
        if seed is not None and is_one:
            seed = range(int(seed), int(seed) + self.num_envs)
        if seed is not None and len(seed) != self.num_envs:
            raise ValueError(f"{len(seed)} seeds for {self.num_envs} environments")
        mask = (options or {}).get("reset_mask")
        if mask is not None:
            mask = np.asarray(mask)
            if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
                raise ValueError(f"reset_mask: {self.num_envs} truths, one of them at least true")
        seeds = None if seed is None else [int(one) for one in seed]
        observations = _call(self._inner.reset, seeds, None if mask is None else mask.tolist())
        chosen = self._all if mask is None else mask
        infos = self._infos(np.zeros(self.num_envs), np.zeros(self.num_envs, np.uint8), chosen)
        return _singles(observations).reshape(self._shape), infos

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Take an action in each environment for an interval; ValueError where one is no number."""
        actions = np.ascontiguousarray(actions, np.float64).tobytes()
        arrays, finals = _call(self._inner.step, actions, self.autoreset_mode.value)
        observations, rewards, reasons, resets, times, terms = arrays
        reasons = np.frombuffer(reasons, np.uint8)
        was_reset = np.frombuffer(resets, np.bool_)
        terminated = (reasons >= N_ALWAYS) & (reasons < N_ALWAYS + self._layout.n_terminate)
        truncated = (reasons > 0) & ~terminated
        times = np.frombuffer(times)
        terms = np.frombuffer(terms).reshape(self.num_envs, -1)
        has_ended = reasons > 0
        if finals is None:
            infos = self._infos(times, reasons, self._all, terms)
        else:
            goes_on = np.where(was_reset, 0, times), np.where(was_reset, 0, reasons)
            infos = self._infos(*goes_on, self._all, np.where(was_reset[:, None], 0, terms))
            infos["final_obs"] = _singles(finals).reshape(self._shape)
            last = {
                "time": times,
                "reason": reasons,
                "terms": _columns(self._layout.terms, terms, has_ended),
            }
            infos["final_info"] = last | {f"_{name}": has_ended for name in last}
            infos["_final_obs"] = infos["_final_info"] = has_ended
        observations = _singles(observations).reshape(self._shape)
        return observations, np.frombuffer(rewards), terminated, truncated, infos

    def _infos(
        self, times: Array, reasons: Array, mask: Array, terms: Array | None = None
    ) -> dict[str, Any]:
        samples, targets = self._inner.drawn()
        targets = np.frombuffer(targets).reshape(self.num_envs, -1)
        if terms is None:
            terms = np.zeros((self.num_envs, len(self._layout.terms)))
        infos: dict[str, Any] = {
            "time": times,
            "sample": np.frombuffer(samples, np.uint64),
            "reason": reasons,
            "targets": _columns(self._layout.targets, targets, mask),
            "terms": _columns(self._layout.terms, terms, mask),
        }
        return infos | {f"_{name}": mask for name in infos}


def _columns(names: list[str], values: Array, mask: Array) -> dict[str, Array]:
    columns = dict(zip(names, values.T, strict=True))
    return columns | {f"_{name}": mask for name in names}


def _singles(data: bytearray) -> Array:
    return np.frombuffer(data, np.float32)


def _written(case: Case | str | Path) -> tuple[str, list[str]]:
    if not isinstance(case, Case):
        case = Case(str(case))
    _, *settings = case.arguments()
    return case.name, [setting for setting in settings if setting != "--set"]


def _warn(odd: list[str]) -> None:
    for message in odd:
        warnings.warn(message, AlewifeWarning, stacklevel=3)


# By `gymnasium.make("alewife/Swim-v0", case=...)` and `make_vec`, once this module is imported
gymnasium.register(
    "alewife/Swim-v0",
    entry_point="alewife.environment:Environment",
    vector_entry_point="alewife.environment:Environments",
)
