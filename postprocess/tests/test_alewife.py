"""The Python interface over the program: cases set, run and swept."""

import json
import os
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import alewife
from alewife.case import to_toml
from alewife.program import call

COARSE = {"mesh.scale": 2, "fluid.viscosity": 2.0}


def test_a_shipped_case_is_set_and_run() -> None:
    case = alewife.load("squirmer-alone").set(COARSE)
    run = case.run(threads=1)
    assert run.status["state"] == "finished"
    assert run.case["fluid"]["viscosity"] == 2.0
    assert run.quantities["squirmer.velocity.x"] == pytest.approx(0.9976, abs=2e-4)
    assert run.field().velocity.shape[1] == 2
    by_quantity = {line["quantity"]: line for line in run.references}
    assert by_quantity["flow.energy_defect"]["verdict"] == "within"
    # The viscosity of a Stokes flow changes the power, not the speed
    other = case.set("fluid.viscosity", 1.0).run(threads=1)
    ratio = run.quantities["squirmer.power"] / other.quantities["squirmer.power"]
    assert ratio == pytest.approx(2.0, rel=1e-9)
    assert case.settings == COARSE


def test_a_run_in_a_given_directory_stays(tmp_path: Path) -> None:
    case = alewife.load("squirmer-alone").set(COARSE)
    run = case.run(tmp_path / "mine")
    assert (tmp_path / "mine" / "series.csv").is_file()
    with pytest.raises(alewife.AlewifeError, match="overwrite"):
        case.run(tmp_path / "mine")
    again = case.run(tmp_path / "mine", overwrite=True)
    assert again.quantities == run.quantities
    temporary = case.run()
    path = temporary.path
    assert path.is_dir()
    del temporary
    assert not path.exists()


def test_what_is_wrong_is_told_as_the_program_tells_it() -> None:
    with pytest.raises(alewife.BadCaseError, match="there is no case `squirmer`") as raised:
        alewife.load("squirmer")
    assert raised.value.code == 66
    case = alewife.load("squirmer-alone")
    with pytest.raises(alewife.BadCaseError, match="accepted: model, viscosity") as raised:
        case.set("fluid.visc", 2.0).check()
    assert raised.value.code == 65
    with pytest.raises(alewife.BadCaseError, match="is the string"):
        case.set("fluid.viscosity", "thick").run()
    with pytest.raises(TypeError, match="a value is missing"):
        case.set("fluid.viscosity")


AT_REST = """
title = "a disc at rest"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.disc.radius = 2.0
boundary.wall = "no-slip"
mesh = { size = 0.8, surface = 0.3 }
time.unsteady = { step = 0.5, end = 0.5 }
[[body]]
name = "disc"
shape.disc.radius = 0.5
center = [0.0, 0.0]
motion = "free"
"""


def test_what_a_run_warns_of_is_a_warning_here(tmp_path: Path) -> None:
    file = tmp_path / "rest.toml"
    file.write_text(AT_REST)
    case = alewife.load(file)
    with pytest.warns(alewife.AlewifeWarning, match="nothing drives this case"):
        run = case.run()
    (one,) = run.warnings
    assert one["message"].startswith("nothing drives") and one["time"] is None, one
    assert one["count"] == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert case.set("body.0.force", [1.0, 0.0]).run().warnings == []
    with pytest.warns(alewife.AlewifeWarning, match="column `warnings`: 1$"):
        table = alewife.sweep(case, {"body.0.torque": [0.0, 1.0]}, out=tmp_path / "s")
    assert list(table["warnings"]) == [1, 0]


def test_a_sweep_is_one_table(tmp_path: Path) -> None:
    case = alewife.load("squirmer-alone").set("mesh.scale", 3)
    modes = [-2.0, 0.0, 2.0]
    grid = {"body.0.gait.squirmer.modes.1": modes}
    table = alewife.sweep(case, grid, out=tmp_path / "s", quantities=["squirmer.power"])
    assert list(table["body.0.gait.squirmer.modes.1"]) == modes
    assert list(table["state"]) == ["finished"] * 3
    power = np.array(table["squirmer.power"])
    # 12 pi (1 + B2^2 / 2 B1^2) for B1 = 3/2, far from walls
    assert power[0] == pytest.approx(power[2], rel=1e-4)
    assert power[2] / power[1] == pytest.approx(1 + 2.0**2 / 2 / 1.5**2, rel=2e-2)


def golden_section(of, low: float, high: float, n: int) -> float:  # noqa: ANN001
    """The place of the only maximum between two numbers after so many values."""
    ratio = (5**0.5 - 1) / 2
    inner = [high - ratio * (high - low), low + ratio * (high - low)]
    values = [of(at) for at in inner]
    for _ in range(n - 2):
        if values[0] > values[1]:
            high, inner, values = inner[1], [0.0, inner[0]], [0.0, values[0]]
            inner[0] = high - ratio * (high - low)
            values[0] = of(inner[0])
        else:
            low, inner, values = inner[0], [inner[1], 0.0], [values[1], 0.0]
            inner[1] = low + ratio * (high - low)
            values[1] = of(inner[1])
    return (low + high) / 2


def test_an_optimiser_finds_the_squirmer_that_spends_least() -> None:
    case = alewife.load("squirmer-alone").set("mesh.scale", 3)

    def efficiency(mode: float) -> float:
        last = case.set("body.0.gait.squirmer.modes.1", mode).run(threads=1).quantities
        return last["squirmer.velocity.x"] ** 2 / last["squirmer.power"]

    # Neither pusher nor puller: B2 = 0 spends least at the same speed
    assert abs(golden_section(efficiency, -2.0, 3.0, 12)) < 0.1


def test_a_gradient_leads_to_the_neutral_squirmer() -> None:
    squirmer = alewife.load("squirmer-unbounded").set("mesh.scale", 2.0)
    second = "body.0.gait.squirmer.modes.1"
    power = squirmer.set(second, 2.0).gradient("squirmer.power", ["fluid.viscosity", second])
    assert power.by["fluid.viscosity"] == pytest.approx(power.value, rel=1e-6)
    # The power is quadratic in it: one step of Newton's method, from two slopes
    slope = squirmer.set(second, 1.0).gradient("squirmer.power", second).by[second]
    best = 1.0 - slope / (power.by[second] - slope)
    assert abs(best) < 1e-4
    with pytest.raises(alewife.BadCaseError, match=r"do you mean `squirmer\.power`"):
        squirmer.gradient("squirmer.powr", ["fluid.viscosity"])


def test_values_are_written_as_toml() -> None:
    value = {"a b": [1, 2.5, True, 'x"y'], "c": np.array([1e-9, 1.0]), "d": np.float64(3)}
    assert to_toml(value) == '{ "a b" = [1, 2.5, true, "x\\"y"], "c" = [1e-09, 1.0], "d" = 3.0 }'
    with pytest.raises(TypeError, match="a number, a text"):
        to_toml(None)  # type: ignore[arg-type]


def test_the_program_is_found_or_missed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert call("--version").startswith("alewife ")
    monkeypatch.setenv("ALEWIFE_BIN", str(tmp_path / "none"))
    with pytest.raises(FileNotFoundError, match="which is no file"):
        alewife.find_program()
    monkeypatch.delenv("ALEWIFE_BIN")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    with pytest.raises(FileNotFoundError, match="pip install alewife"):
        alewife.find_program()


@pytest.mark.skipif(sys.platform != "linux", reason="the end of a parent is told on Linux")
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGKILL])
def test_a_run_ends_with_an_interrupt_of_python_alone_and_with_its_death(
    tmp_path: Path, sent: signal.Signals
) -> None:
    text = (
        "import alewife, signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "alewife.load('added-mass').set('time.unsteady.end', 1e3)"
        f".run({str(tmp_path / 'r')!r}, threads=1)"
    )
    process = subprocess.Popen([sys.executable, "-c", text], stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while not (tmp_path / "r" / "series.csv").is_file() and time.monotonic() < deadline:
        time.sleep(0.05)
    time.sleep(0.5)
    # No terminal tells the program
    process.send_signal(sent)
    process.wait(timeout=60)
    status = {"state": "running"}
    while status["state"] == "running" and time.monotonic() < deadline:
        time.sleep(0.05)
        status = json.loads((tmp_path / "r" / "status.json").read_text())
    assert status["state"] == "stopped"
    assert list((tmp_path / "r" / "checkpoints").glob("*.state"))


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_an_interrupted_run_leaves_its_state_and_continues(tmp_path: Path) -> None:
    text = (
        # In the background of a shell Ctrl-C is ignored, and would be here, too
        "import alewife, signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "alewife.load('added-mass').set('time.unsteady.end', 1e3)"
        f".run({str(tmp_path / 'r')!r}, threads=1)"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", text], stderr=subprocess.PIPE, start_new_session=True
    )
    deadline = time.monotonic() + 60
    while not (tmp_path / "r" / "series.csv").is_file() and time.monotonic() < deadline:
        time.sleep(0.05)
    time.sleep(0.5)
    os.killpg(process.pid, signal.SIGINT)
    _, messages = process.communicate(timeout=60)
    assert b"KeyboardInterrupt" in messages
    assert list((tmp_path / "r" / "checkpoints").glob("*.state"))
