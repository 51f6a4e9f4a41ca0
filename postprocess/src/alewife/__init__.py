"""Cases of alewife set, run and read from Python; the program does the work.

>>> import alewife
>>> case = alewife.load("squirmer-alone").set("mesh.scale", 2)
>>> run = case.run()
>>> round(run.quantities["squirmer.velocity.x"], 2)
1.0
"""

from alewife.case import Case, Gradient, load
from alewife.program import (
    AlewifeError,
    AlewifeWarning,
    BadCaseError,
    SolverError,
    StoppedError,
    find_program,
)
from alewife.run import CaseRun
from alewife.session import Session, State, session
from alewife.sweep import sweep

__all__ = [
    "AlewifeError",
    "AlewifeWarning",
    "BadCaseError",
    "Case",
    "CaseRun",
    "Gradient",
    "Session",
    "SolverError",
    "State",
    "StoppedError",
    "find_program",
    "load",
    "session",
    "sweep",
]
