"""Exported models in MuJoCo 3.3.7, where it is installed: masses, accelerations, motions, URDF."""

from __future__ import annotations

import csv
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco", reason="pip install mujoco==3.3.7")

pytestmark = [
    pytest.mark.skipif("ALEWIFE_BIN" not in os.environ, reason="needs the program: see test.sh"),
    pytest.mark.skipif(mujoco.__version__ != "3.3.7", reason="other versions have another lift"),
]

ROOT = Path(__file__).parents[2]
ROBOT = ROOT / "solver/tests/reduced/robot.toml"
# What the tests in Rust compare with; ALEWIFE_UPDATE=1 writes it
STORED = ROOT / "solver/tests/reduced/mujoco.csv"
Numbers = dict[str, np.ndarray]
CASES = {"fish": "tendon-fish", "eel": "robot-eel", "robot": str(ROBOT)}


def alewife(*words: str | Path, codes: tuple[int, ...] = (0,)) -> None:
    command = [os.environ["ALEWIFE_BIN"], *map(str, words)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode in codes, done.stderr


def exported(case: str, place: Path, *settings: str) -> mujoco.MjModel:
    """The model of a case."""
    out = place / "model.xml"
    alewife("export", case, out, *(word for one in settings for word in ("--set", one)))
    return mujoco.MjModel.from_xml_path(str(out))


def states(model: mujoco.MjModel, count: int, *, driven: bool = True) -> list[Numbers]:
    """States about the first keyframe, with masses and accelerations in the fluid and without."""
    if not driven:
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    fluid = model.opt.density, model.opt.viscosity
    drawn = np.random.default_rng(7)
    data = mujoco.MjData(model)
    found = []
    for _ in range(count):
        mujoco.mj_resetDataKeyframe(model, data, 0)
        change = drawn.uniform(-0.5, 0.5, model.nv)
        sliders = model.jnt_type == mujoco.mjtJoint.mjJNT_SLIDE
        change[model.jnt_dofadr[sliders]] *= 0.1
        mujoco.mj_integratePos(model, data.qpos, change, 1.0)
        data.qvel[:] = drawn.uniform(-1.0, 1.0, model.nv)
        model.opt.density, model.opt.viscosity = fluid
        mujoco.mj_forward(model, data)
        wet = data.qacc.copy()
        model.opt.density = model.opt.viscosity = 0.0
        mujoco.mj_forward(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, mass, data.qM)
        found.append(
            {
                "place": data.qpos.copy(),
                "rate": data.qvel.copy(),
                "mass": mass.ravel(),
                "acceleration": data.qacc.copy(),
                "wet": wet,
            }
        )
    return found


def stored() -> dict[tuple[str, int, str], np.ndarray]:
    with STORED.open(encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    return {
        (row[0], int(row[1]), row[2]): np.array([float(word) for word in row[3].split()])
        for row in rows
    }


def test_masses_and_accelerations_are_those_that_are_stored(tmp_path: Path) -> None:
    found = {}
    for name, case in CASES.items():
        model = exported(case, tmp_path)
        for nth, state in enumerate(states(model, 3, driven=name != "eel")):
            for what, values in state.items():
                found[name, nth, what] = values
    if "ALEWIFE_UPDATE" in os.environ:
        rows = ["case,state,what,values"]
        for (name, nth, what), values in found.items():
            rows.append(f"{name},{nth},{what},{' '.join(repr(float(v)) for v in values)}")
        STORED.write_text("\n".join(rows) + "\n", encoding="utf-8")
    expected = stored()
    assert expected.keys() == found.keys()
    for key, values in found.items():
        size = np.abs(expected[key]).max()
        assert np.abs(values - expected[key]).max() <= 1e-12 * size, key


def test_a_fish_swims_as_its_case_the_better_the_shorter_the_steps(tmp_path: Path) -> None:
    errors = []
    for step in (0.001, 0.0005, 0.00025):
        out = tmp_path / f"run-{step}"
        settings = [f"time.unsteady.step={step}", "time.unsteady.end=1"]
        model = exported("tendon-fish/1.75", tmp_path, *settings)
        words = [word for one in settings for word in ("--set", one)]
        # Its references are of another time: code 20
        alewife("run", "tendon-fish/1.75", "--out", out, *words, codes=(0, 20))
        with (out / "series.csv").open(encoding="utf-8") as file:
            last = list(csv.DictReader(file))[-1]
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        for _ in range(round(1.0 / step)):
            mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        way = []
        for name in ("head", "tail4"):
            body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
            place = [float(last[f"{name}.{axis}"]) for axis in "xyz"]
            way.append(np.linalg.norm(data.xipos[body] - place))
        errors.append(max(way))
    # MuJoCo's steps are of first order, those of the case of second
    order = np.log2(errors[0] / errors[-1]) / 2
    assert errors[-1] < 3e-4, errors
    assert 0.8 < order < 1.5, (errors, order)


def test_a_robot_comes_back_from_mjcf(tmp_path: Path) -> None:
    exported(str(ROBOT), tmp_path)
    alewife("import", tmp_path / "model.xml", tmp_path / "back.toml")
    again = exported(str(tmp_path / "back.toml"), tmp_path)
    first = exported(str(ROBOT), tmp_path)
    for one, other in zip(states(first, 2), states(again, 2), strict=True):
        for what in ("mass", "acceleration", "wet"):
            size = np.abs(one[what]).max()
            assert np.abs(one[what] - other[what]).max() < 1e-11 * size, what


def test_urdf_has_the_masses_and_axes_of_the_case(tmp_path: Path) -> None:
    out = tmp_path / "robot.urdf"
    alewife("export", ROBOT, out)
    urdf = mujoco.MjModel.from_xml_path(str(out))
    mjcf = exported(str(ROBOT), tmp_path)
    # MuJoCo fixes the first link of URDF to the world: what hangs on it is compared
    ours, theirs = mujoco.MjData(mjcf), mujoco.MjData(urdf)
    ours.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    mujoco.mj_forward(mjcf, ours)
    mujoco.mj_forward(urdf, theirs)
    for name in ("fin", "weight", "rod"):
        a = mujoco.mj_name2id(mjcf, mujoco.mjtObj.mjOBJ_BODY, name)
        b = mujoco.mj_name2id(urdf, mujoco.mjtObj.mjOBJ_BODY, name)
        assert urdf.body_mass[b] == pytest.approx(mjcf.body_mass[a], rel=1e-12)
        moments = [np.sort(model.body_inertia[body]) for model, body in ((urdf, b), (mjcf, a))]
        assert moments[0] == pytest.approx(moments[1], rel=1e-9)
        assert theirs.xipos[b] == pytest.approx(ours.xipos[a], abs=1e-12)
        joints = [model.body_jntadr[body] for model, body in ((mjcf, a), (urdf, b))]
        assert theirs.xaxis[joints[1]] == pytest.approx(ours.xaxis[joints[0]], abs=1e-12)
        assert theirs.xanchor[joints[1]] == pytest.approx(ours.xanchor[joints[0]], abs=1e-12)
