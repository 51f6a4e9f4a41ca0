"""Sessions act and observe in this process, with the bits of a run that repeats them."""

from __future__ import annotations

import subprocess
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from test_pages import program

import alewife
from alewife_post import open_run

CASE = """
title = "three links on command"
geometry = "planar"
fluid = { model = "navier-stokes", density = 1.0, viscosity = 0.2 }
domain.box = { min = [-2.5, -1.5], max = [2.5, 1.5] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 0.6, surface = 0.21 }
time.unsteady = { step = 0.05, end = 0.2 }
output = { checkpoint = { time = 0.05 } }

[[swimmer]]
name = "eel"

[swimmer.kind.chain]
links = [[0.4, 0.12], [0.4, 0.12], [0.4, 0.1]]
gap = 0.2
joints = [
    { bent.angle.command = { limits = ["-40 deg", "40 deg"], rate = 3.0, filter = 0.05 } },
    { bent.angle.command = { limits = [-0.6, 0.6], filter = 0.06 } },
]
"""


@pytest.fixture(scope="module")
def eel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("alewife_session")
    path = tmp_path_factory.mktemp("session") / "eel.toml"
    path.write_text(CASE, encoding="utf-8")
    return path


def act(session: alewife.Session) -> None:
    while not session.is_over:
        session.command({"eel.joint.1": np.sin(9 * session.time), "eel.joint.2": 0.3})
        session.advance(0.05)


def test_a_session_acts_and_observes(eel: Path) -> None:
    with alewife.session(eel) as session:
        assert session.commands == ["eel.joint.1", "eel.joint.2"]
        session.command("eel.joint.2", 0.5)
        session.advance(0.1)
        seen = session.observe(["time", "eel-3.joint.angle", "velocity", "pressure", "nodes"])
        assert seen["time"] == session.time == 0.1
        assert seen["eel-3.joint.angle"] == session.commanded("eel.joint.2")["value"] > 0.2
        assert seen["velocity"].shape == seen["nodes"].shape == (len(seen["nodes"]), 2)
        assert np.linalg.norm(seen["velocity"], axis=1).max() > 0.1
        kept = seen["velocity"].copy()
        session.advance(0.05)
        assert np.array_equal(seen["velocity"], kept), "an array is the caller's own"
        cells = session.observe("cells")
        assert cells.shape[1] == 6
        assert cells.max() == len(session.observe("nodes")) - 1


def test_a_run_directory_is_repeated_with_its_bits(eel: Path, tmp_path: Path) -> None:
    with alewife.session(eel, tmp_path / "session") as session:
        act(session)
        recording = session.recording
    run = open_run(tmp_path / "session")
    assert run.status["state"] == "finished"
    commands = tmp_path / "session" / "commands.csv"
    assert recording.count("eel.joint.1") == commands.read_text().count("eel.joint.1") == 4
    subprocess.run(
        [program(), "run", eel, "--quiet", "--replay", commands, "--out", tmp_path / "again"],
        check=True,
        capture_output=True,
    )
    again = open_run(tmp_path / "again")
    assert list(again.series) == list(run.series)
    for name, values in run.series.items():
        assert np.array_equal(again.series[name], values, equal_nan=True), name


def test_a_stopped_session_continues_by_replay(eel: Path, tmp_path: Path) -> None:
    with alewife.session(eel, tmp_path / "whole") as session:
        act(session)
    with alewife.session(eel, tmp_path / "part") as session:
        session.command({"eel.joint.1": 0.0, "eel.joint.2": 0.3})
        session.advance(0.05)
    assert open_run(tmp_path / "part").status["state"] == "stopped"
    commands = tmp_path / "whole" / "commands.csv"
    subprocess.run(
        [program(), "run", eel, "--quiet", "--out", tmp_path / "part", "--replay", commands],
        check=True,
        capture_output=True,
    )
    whole, part = (open_run(tmp_path / name).series for name in ("whole", "part"))
    for name, values in whole.items():
        assert np.array_equal(part[name], values, equal_nan=True), name


def test_states_and_forks(eel: Path, tmp_path: Path) -> None:
    with alewife.session(eel) as session, session.fork() as fork:
        session.command("eel.joint.1", 0.4)
        session.advance(0.05)
        state = session.save()
        session.advance(0.05)
        expected = session.observe("eel.x")
        assert fork.time == 0.0
        session.restore(state)
        assert session.time == state.time == 0.05
        session.advance(0.05)
        assert session.observe("eel.x") == expected
        state.write(tmp_path / "a.state")
    with alewife.session(eel, resume=tmp_path / "a.state") as session:
        session.advance(0.05)
        assert session.observe("eel.x") == expected


def test_ten_at_once(eel: Path) -> None:
    def way(nth: int) -> float:
        with alewife.session(eel) as session:
            session.command("eel.joint.2", 0.05 * nth)
            session.advance(0.05)
            return session.observe("eel.x")

    with ThreadPoolExecutor(10) as pool:
        together = list(pool.map(way, range(10)))
    assert together[7] == way(7)
    assert len(set(together)) == 10


def test_other_threads_go_on(eel: Path) -> None:
    ticks = []
    done = threading.Event()

    def tick() -> None:
        while not done.wait(0.002):
            ticks.append(None)

    thread = threading.Thread(target=tick)
    with alewife.session(eel) as session:
        thread.start()
        session.advance(0.1)
        done.set()
    thread.join()
    assert len(ticks) > 3


def test_mistakes(eel: Path) -> None:
    with alewife.session(eel) as session:
        with pytest.raises(alewife.BadCaseError, match=r"did you mean eel\.joint\.1"):
            session.command("eel.joint.9", 0.1)
        with pytest.raises(alewife.BadCaseError, match="finite number"):
            session.command("eel.joint.1", float("nan"))
        with pytest.raises(alewife.BadCaseError, match=r"raise time\.unsteady\.end"):
            session.advance(9.0)
        with pytest.raises(alewife.BadCaseError, match="there is no quantity"):
            session.observe("eel.q")
        with pytest.raises(TypeError, match="a number"):
            session.command("eel.joint.1")
    with pytest.raises(alewife.BadCaseError, match="closed"):
        session.advance(0.1)
    with pytest.raises(alewife.BadCaseError, match="limits"):
        key = "swimmer.0.kind.chain.joints.1.bent.angle.command.limits"
        alewife.session(alewife.Case(str(eel)).set(key, [0.5, -0.5]))
    with pytest.raises(ValueError, match="threads"):
        alewife.session(eel, threads=0)


def test_a_run_by_itself_is_refused(eel: Path, tmp_path: Path) -> None:
    ended = subprocess.run(
        [program(), "run", eel, "--out", tmp_path / "run"], capture_output=True, text=True
    )
    assert ended.returncode == 65
    assert "eel.toml:" in ended.stderr
    assert "`eel.joint.1` waits for commands" in ended.stderr
    assert "--replay commands.csv" in ended.stderr
    assert not (tmp_path / "run").exists()
