"""Compares direct solvers for sparse linear systems: MUMPS, UMFPACK, PARDISO and SuperLU.

Every folder given holds one system in NumPy's format: `columns.npy` (u64, n + 1) and `rows.npy`
(u64) and `values.npy` (f64), the matrix in compressed sparse columns, and `rhs.npy` (f64).

The solvers are MUMPS (sequential, ordered by METIS) and UMFPACK as Debian has them, PARDISO of
the MKL that PyPI has (matrix type 11, real unsymmetric), and SciPy's SuperLU. Each runs under
several settings, its defaults among them. The table shows, for each solver, the setting that is
fastest at a refactorisation and a solve together, among those right to a relative residual of
1e-9, and another row for the setting that solves fastest if that one is faster by more than a
twentieth. `--all` shows every setting. The JSON has them all.

What the columns say:

- analysis, refactorisation, solve: process CPU seconds, best (median) of the repeats; one thread
  on one core, each setting in a process of its own. A repeat is the mean over as many runs as fill
  a fifth of a second, as the clock may be coarse. A refactorisation reuses the analysis; its
  values are those that were analysed, which favours settings that scale or match by the values at
  the analysis. SuperLU cannot reuse one: its refactorisation is all of it.
- entries: the entries of both factors, as the package counts them.
- memory: how far the first analysis, factorisation and solve raised the peak resident size, over
  what the process held with the matrix in the package's own format.
- residual: |b - A x| / |b| in the 2-norm. Iterative refinement is off but where the setting
  is named for it; PARDISO may do steps of its own where it perturbed pivots. The table says how
  many were done.

BLAS: MUMPS and UMFPACK get the OpenBLAS kernels, and PARDISO the MKL instruction set, that have the
highest rate of a matrix product on this processor. The rates are printed.

`--figures` takes figures of other solvers, such as the one of this crate:
`{"solver": {"folder's name": {"n", "nnz", "analyse_s", "refactorise_s", "solve_s",
"factor_entries", "memory_bytes", "residual"}}}`. The ratios divide by those of the first solver
there: where one is above 1, that solver is better.

`sh install.sh` installs what this needs; then `.venv/bin/python compare.py FOLDER...`.
"""

import argparse
import ctypes
import json
import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sparse
from solvers import SOLVERS, Settings, mkl, pointer

Row = dict[str, Any]

TOLERANCE = 1e-9
"""The relative residual above which a solution is wrong."""

BATCH = 0.2
"""CPU seconds that the runs of one repeat fill."""

MOST_RUNS = 1000
"""How many runs a repeat has at most."""

ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "MKL_THREADING_LAYER": "SEQUENTIAL",
}


def load(folder: Path) -> tuple[sparse.csc_array, np.ndarray]:
    """The matrix and right hand side of a folder."""
    columns, rows = (np.load(folder / f"{k}.npy").astype(np.int32) for k in ("columns", "rows"))
    values, rhs = (np.load(folder / f"{k}.npy").astype(np.float64) for k in ("values", "rhs"))
    n = len(columns) - 1
    matrix = sparse.csc_array((values, rows, columns), shape=(n, n))
    matrix.sum_duplicates()
    return matrix, rhs


def resident(field: str) -> int:
    """Resident bytes of the process: `VmRSS` now, `VmHWM` the peak."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return int(line.split()[1]) * 1024
    raise RuntimeError(f"/proc/self/status has no {field}")


def timed(
    run: Callable[[], None], before: Callable[[], None], repeats: int, budget: float
) -> list[float]:
    """CPU seconds of each repeat of `run`; no more repeats once they took `budget` seconds.

    `before` runs before each `run`, untimed.
    """
    times: list[float] = []
    spent = 0.0
    while len(times) < repeats and spent < budget:
        total, runs = 0.0, 0
        while total < BATCH and runs < MOST_RUNS:
            before()
            start = time.process_time()
            run()
            total += time.process_time() - start
            runs += 1
        times.append(total / runs)
        spent += total
    return times


def measure(folder: Path, name: str, settings: Settings, repeats: int, budget: float) -> Row:
    """The figures of one solver under one setting on one system."""
    matrix, rhs = load(folder)
    solver = SOLVERS[name](matrix, rhs, settings)
    Path("/proc/self/clear_refs").write_text("5")  # the peak starts anew
    held = resident("VmRSS")
    solver.analyse()
    solver.factorise()
    solver.solve()
    memory = resident("VmHWM") - held

    def nothing() -> None:
        pass

    def release() -> None:
        solver.release_factors()
        solver.release_analysis()

    analyse = timed(solver.analyse, release, repeats, budget)
    solver.factorise()
    refactorise = timed(solver.factorise, solver.release_factors, repeats, budget)
    solve = timed(solver.solve, nothing, repeats, budget)
    residual = np.linalg.norm(rhs - matrix @ solver.x) / np.linalg.norm(rhs)
    row: Row = {"n": matrix.shape[0], "nnz": matrix.nnz}
    for key, times in (("analyse", analyse), ("refactorise", refactorise), ("solve", solve)):
        row[f"{key}_s"] = min(times)
        row[f"{key}_median_s"] = statistics.median(times)
    return row | {
        "factor_entries": solver.entries(),
        "memory_bytes": memory,
        "residual": float(residual),
        "refinements": solver.refinements(),
    }


def product_rate(library: str) -> float:
    """The rate of a matrix product by OpenBLAS or MKL, in 1e9 operations a CPU second."""
    dgemm = (mkl() if library == "mkl" else ctypes.CDLL("libopenblas.so.0")).dgemm_
    n = 768
    a, b, c = (np.full((n, n), 1.0 + k) for k in range(3))
    size = ctypes.byref(ctypes.c_int(n))
    one = ctypes.byref(ctypes.c_double(1.0))
    zero = ctypes.byref(ctypes.c_double(0.0))
    letter = ctypes.c_char_p(b"N")

    def multiply() -> None:
        operands = (pointer(a), size, pointer(b), size, zero, pointer(c), size)
        dgemm(letter, letter, size, size, size, one, *operands)

    return 2e-9 * n**3 / min(timed(multiply, lambda: None, 8, 10.0))


def in_process(task: dict[str, Any], environment: dict[str, str], limit: int) -> dict[str, Any]:
    """What a task answers, run in a process of its own; `{"error"}` where it failed."""
    done = subprocess.run(
        [sys.executable, __file__, "--task", json.dumps(task | {"limit": limit})],
        env=os.environ | ONE_THREAD | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode < 0:
        return {"error": f"signal {-done.returncode} (24: over {limit} CPU seconds)"}
    lines = (done.stdout if done.returncode == 0 else done.stderr).strip().splitlines()
    if done.returncode != 0 or not lines:
        return {"error": lines[-1] if lines else "no answer"}
    return json.loads(lines[-1])


def run_task(task: dict[str, Any]) -> None:
    """Does what `in_process` asked."""
    resource.setrlimit(resource.RLIMIT_CPU, (task["limit"], task["limit"]))
    if "rate" in task:
        answer: Row = {"rate": product_rate(task["rate"])}
    else:
        settings = SOLVERS[task["solver"]].variants[task["variant"]]
        folder = Path(task["folder"])
        answer = measure(folder, task["solver"], settings, task["repeats"], task["budget"])
    print(json.dumps(answer))


def fastest_kernels() -> tuple[dict[str, str], list[str]]:
    """The environment in which OpenBLAS and MKL multiply fastest, and a report."""
    wide = "avx512f" in Path("/proc/cpuinfo").read_text()
    libraries = {
        "openblas": ("OPENBLAS_CORETYPE", ["Haswell", "Zen"] + ["SkylakeX"] * wide),
        "mkl": ("MKL_ENABLE_INSTRUCTIONS", ["AVX2"] + ["AVX512"] * wide),
    }
    best: dict[str, str] = {}
    report = []
    for library, (variable, values) in libraries.items():
        rates = {}
        for value in ["", *values]:
            given = {variable: value} if value else {}
            answer = in_process({"rate": library}, given, 60)
            rates[value] = answer.get("rate", 0.0)
        chosen = max(rates, key=lambda value: rates[value])
        if chosen:
            best[variable] = chosen
        shown = ", ".join(f"{value or 'unset'} {rate:.1f}" for value, rate in rates.items())
        report.append(f"dgemm by {library}, GF/s by {variable}: {shown}; {chosen or 'unset'} used")
    return best, report


def chosen_rows(rows: list[Row]) -> list[Row]:
    """Of one solver's rows: the fastest to refactorise and solve, and to solve if another."""
    right = [row for row in rows if row.get("residual", 1.0) < TOLERANCE]
    if not right:
        return rows[:1]
    first = min(right, key=lambda row: row["refactorise_s"] + row["solve_s"])
    second = min(right, key=lambda row: row["solve_s"])
    return [first] if second["solve_s"] > 0.95 * first["solve_s"] else [first, second]


def time_cell(row: Row, key: str) -> str:
    """Best (median)."""
    best = f"{row[f'{key}_s']:.4g}"
    median = row.get(f"{key}_median_s")
    return best if median is None else f"{best} ({median:.4g})"


def table(rows: list[Row]) -> str:
    """The Markdown table of some rows."""
    heads = ["system", "solver", "analysis (s)", "refactorisation (s)", "solve (s)"]
    heads += ["entries (1e6)", "memory (MiB)", "residual"]
    lines = ["| " + " | ".join(heads) + " |", "|---|---|" + "--:|" * (len(heads) - 2)]
    for row in rows:
        cells = [row["system"], f"{row['solver']}: {row['variant']}".removesuffix(": ")]
        if "error" in row:
            cells += [row["error"].replace("|", "/"), "", "", "", "", ""]
        else:
            cells += [time_cell(row, key) for key in ("analyse", "refactorise", "solve")]
            cells += [f"{row['factor_entries'] / 1e6:.2f}", f"{row['memory_bytes'] / 2**20:.0f}"]
            refined = row.get("refinements", 0)
            cells += [f"{row['residual']:.1e}" + (f", refined {refined} times" if refined else "")]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def ratios(rows: list[Row], reference: str) -> str:
    """The Markdown table of each row's figures over the reference's for the same system."""
    keys = ["analyse_s", "refactorise_s", "solve_s", "factor_entries", "memory_bytes"]
    lines = [f"Over {reference}'s:", "", "| system | solver | " + " | ".join(keys) + " |"]
    lines.append("|---|---|" + "--:|" * len(keys))
    ours = {row["system"]: row for row in rows if row["solver"] == reference}
    for row in rows:
        own = ours.get(row["system"])
        if own is None or own is row or "error" in row:
            continue
        cells = [f"{row[key] / own[key]:.2f}" if own[key] else "-" for key in keys]
        name = f"{row['solver']}: {row['variant']}".removesuffix(": ")
        lines.append(f"| {row['system']} | {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folders", nargs="*", type=Path, help="systems")
    parser.add_argument("--solvers", default=",".join(SOLVERS), help="which, by comma")
    parser.add_argument("--repeats", type=int, default=5, help="of each phase (default 5)")
    parser.add_argument(
        "--budget", type=float, default=10.0, help="no more repeats after (CPU s, default 10)"
    )
    parser.add_argument("--limit", type=int, default=120, help="of a setting (CPU s, default 120)")
    parser.add_argument("--core", type=int, help="to run on (default: the last one allowed)")
    parser.add_argument("--figures", type=Path, help="JSON of other solvers' figures")
    parser.add_argument("--output", type=Path, default=Path("compare.json"), help="JSON to write")
    parser.add_argument("--all", action="store_true", help="every setting in the table")
    parser.add_argument("--task", help=argparse.SUPPRESS)
    return parser.parse_args()


def main() -> None:
    """Compares the solvers on the folders of the command line."""
    options = arguments()
    if options.task:
        run_task(json.loads(options.task))
        return
    core = max(os.sched_getaffinity(0)) if options.core is None else options.core
    os.sched_setaffinity(0, {core})
    environment, report = fastest_kernels()
    print("\n".join(report), flush=True)
    figures = json.loads(options.figures.read_text()) if options.figures else {}
    every: list[Row] = []
    shown: list[Row] = []
    for folder in options.folders:
        system = folder.resolve().name
        for name, systems in figures.items():
            if system in systems:
                shown.append({"system": system, "solver": name, "variant": ""} | systems[system])
        for name in options.solvers.split(","):
            rows = []
            for variant in SOLVERS[name].variants:
                task = {"solver": name, "variant": variant, "folder": str(folder)}
                task |= {"repeats": options.repeats, "budget": options.budget}
                answer = in_process(task, environment, options.limit)
                rows.append({"system": system, "solver": name, "variant": variant} | answer)
                print(json.dumps(rows[-1]), file=sys.stderr, flush=True)
            every += rows
            shown += rows if options.all else chosen_rows(rows)
    print("\n" + table(shown))
    if figures:
        print("\n" + ratios(shown, next(iter(figures))))
    result = {"environment": environment, "kernels": report, "rows": every, "figures": figures}
    options.output.write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main()
