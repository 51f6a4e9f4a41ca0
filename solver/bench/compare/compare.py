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
import ctypes.util
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

Settings = dict[str, Any]
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


def pointer(array: np.ndarray) -> ctypes.c_void_p:
    """The address of an array's data."""
    return ctypes.c_void_p(array.ctypes.data)


def mkl() -> ctypes.CDLL:
    """MKL, of this Python environment."""
    found = sorted((Path(sys.prefix) / "lib").glob("libmkl_rt.so*"))
    if not found:
        raise FileNotFoundError("no libmkl_rt in this Python environment")
    return ctypes.CDLL(str(found[-1]))


class Solver(ABC):
    """A direct solver of one system: set up, then analyse, factorise, solve."""

    variants: ClassVar[dict[str, Settings]]

    def __init__(self, matrix: sparse.csc_array, rhs: np.ndarray, settings: Settings) -> None:
        """Takes over the matrix in the package's own format."""
        self.matrix = matrix
        self.rhs = rhs
        self.settings = settings
        self.x = np.zeros_like(rhs)

    def release_analysis(self) -> None:  # noqa: B027
        """Frees what an analysis left."""

    def release_factors(self) -> None:  # noqa: B027
        """Frees what a factorisation left."""

    @abstractmethod
    def analyse(self) -> None:
        """Orders the unknowns and works out the factors' structure."""

    @abstractmethod
    def factorise(self) -> None:
        """Factorises by the analysis there is."""

    @abstractmethod
    def solve(self) -> None:
        """Solves for `rhs` into `x`."""

    @abstractmethod
    def entries(self) -> int:
        """How many entries both factors have."""

    def refinements(self) -> int:
        """How many steps of refinement the last solve did."""
        return 0


class Mumps(Solver):
    """Sequential MUMPS, ordered by METIS."""

    # 6: matching, 8: scaling; `threshold`: of the partial pivoting.
    variants: ClassVar = {
        "defaults": {},
        "no matching": {6: 0},
        "no scaling": {8: 0},
        "no matching or scaling": {6: 0, 8: 0},
        "no matching, threshold 1e-6": {6: 0, "threshold": 1e-6},
    }
    # Silent; centralised triplets; METIS; no refinement; no error analysis; slack in memory; one
    # right hand side at a time; sequential analysis.
    always: ClassVar = {1: 0, 2: 0, 3: 0, 4: 0, 5: 0, 18: 0, 7: 5, 10: 0, 11: 0, 14: 60, 27: 1}
    always |= {28: 1}

    def __init__(self, matrix: sparse.csc_array, rhs: np.ndarray, settings: Settings) -> None:
        """Sets MUMPS up."""
        super().__init__(matrix, rhs, settings)
        self.library = self.build()
        triplets = matrix.tocoo()
        self.rows = triplets.row.astype(np.int32) + np.int32(1)
        self.columns = triplets.col.astype(np.int32) + np.int32(1)
        self.values = triplets.data.copy()
        self.mumps = ctypes.c_void_p(
            self.library.open_mumps(
                matrix.shape[0],
                ctypes.c_int64(matrix.nnz),
                pointer(self.rows),
                pointer(self.columns),
                pointer(self.values),
            )
        )
        for index, value in (self.always | settings).items():
            if index == "threshold":
                self.library.set_real(self.mumps, 1, ctypes.c_double(value))
            else:
                self.library.set_integer(self.mumps, index, value)

    @staticmethod
    def build() -> ctypes.CDLL:
        """The flat interface, compiled."""
        with tempfile.TemporaryDirectory() as folder:
            library = Path(folder) / "mumps.so"
            source = Path(__file__).parent / "mumps.c"
            command = ["cc", "-O2", "-shared", "-fPIC", "-I/usr/include/mumps_seq", "-o", library]
            subprocess.run([*command, source, "-ldmumps_seq"], check=True)
            loaded = ctypes.CDLL(str(library))
        loaded.open_mumps.restype = ctypes.c_void_p
        return loaded

    def run(self, job: int) -> None:
        """Runs a job; raises by its error."""
        error = self.library.run_job(self.mumps, job, pointer(self.x))
        if error < 0:
            detail = self.library.information(self.mumps, 2)
            raise RuntimeError(f"MUMPS: job {job} ended with {error}, {detail}")

    def analyse(self) -> None:
        """Job 1."""
        self.run(1)

    def factorise(self) -> None:
        """Job 2."""
        self.run(2)

    def solve(self) -> None:
        """Job 3."""
        self.x[:] = self.rhs
        self.run(3)

    def entries(self) -> int:
        """INFOG(29), in millions where negative."""
        count = self.library.information(self.mumps, 29)
        return count if count >= 0 else -count * 1_000_000


class Umfpack(Solver):
    """UMFPACK with 32-bit indices."""

    # By index of Control: 3, 15: thresholds; 5: strategy (1 unsymmetric, 3 symmetric);
    # 10: ordering (1 AMD, 3 METIS); 16: row scaling.
    variants: ClassVar = {
        "defaults": {},
        "symmetric, AMD": {5: 3, 10: 1},
        "symmetric, METIS": {5: 3, 10: 3},
        "symmetric, METIS, threshold 1e-6": {5: 3, 10: 3, 15: 1e-6},
    }

    def __init__(self, matrix: sparse.csc_array, rhs: np.ndarray, settings: Settings) -> None:
        """Loads UMFPACK and its defaults."""
        super().__init__(matrix, rhs, settings)
        name = ctypes.util.find_library("umfpack")
        if name is None:
            raise FileNotFoundError("no libumfpack")
        self.library = ctypes.CDLL(name)
        self.control = np.zeros(20)
        self.info = np.zeros(90)
        self.library.umfpack_di_defaults(pointer(self.control))
        self.control[7] = 0.0  # no refinement
        for index, value in settings.items():
            self.control[index] = value
        self.arrays = [pointer(a) for a in (matrix.indptr, matrix.indices, matrix.data)]
        self.symbolic = ctypes.c_void_p()
        self.numeric = ctypes.c_void_p()

    def check(self, status: int) -> None:
        """Raises by a status that is an error."""
        if status != 0:
            raise RuntimeError(f"UMFPACK: status {status}")

    def release_analysis(self) -> None:
        """Frees the symbolic object."""
        self.library.umfpack_di_free_symbolic(ctypes.byref(self.symbolic))

    def release_factors(self) -> None:
        """Frees the numeric object."""
        self.library.umfpack_di_free_numeric(ctypes.byref(self.numeric))

    def analyse(self) -> None:
        """`umfpack_di_symbolic`."""
        n = self.matrix.shape[0]
        where = ctypes.byref(self.symbolic)
        options = (pointer(self.control), pointer(self.info))
        self.check(self.library.umfpack_di_symbolic(n, n, *self.arrays, where, *options))

    def factorise(self) -> None:
        """`umfpack_di_numeric`."""
        where = ctypes.byref(self.numeric)
        options = (pointer(self.control), pointer(self.info))
        self.check(self.library.umfpack_di_numeric(*self.arrays, self.symbolic, where, *options))

    def solve(self) -> None:
        """`umfpack_di_solve`."""
        vectors = (pointer(self.x), pointer(self.rhs))
        options = (pointer(self.control), pointer(self.info))
        self.check(self.library.umfpack_di_solve(0, *self.arrays, *vectors, self.numeric, *options))

    def entries(self) -> int:
        """Those of L and of U."""
        counts = [ctypes.c_int() for _ in range(5)]
        self.library.umfpack_di_get_lunz(*(ctypes.byref(c) for c in counts), self.numeric)
        return counts[0].value + counts[1].value


class Pardiso(Solver):
    """MKL's PARDISO."""

    # By 0-based index of iparm: 1: ordering (2 METIS, 3 its parallel version), 7: most steps of
    # refinement (1 only checks), 9: perturbation of pivots 10^-k, 10: scaling, 12: matching,
    # 23: two-level factorisation.
    variants: ClassVar = {
        "defaults": {},
        "ordering 3": {1: 3},
        "two-level": {23: 1},
        "two-level, no scaling or matching": {10: 0, 12: 0, 23: 1},
        "improved two-level, no scaling or matching": {10: 0, 12: 0, 23: 10},
        "two-level, no scaling or matching, refined": {7: 2, 10: 0, 12: 0, 23: 1},
        "improved two-level, no scaling or matching, refined": {7: 2, 10: 0, 12: 0, 23: 10},
    }

    def __init__(self, matrix: sparse.csc_array, rhs: np.ndarray, settings: Settings) -> None:
        """Turns the matrix to rows."""
        super().__init__(matrix, rhs, settings)
        self.library = mkl()
        by_rows = matrix.tocsr()
        by_rows.sort_indices()
        self.by_rows = by_rows
        self.arrays = [pointer(a) for a in (by_rows.data, by_rows.indptr, by_rows.indices)]
        self.handle = np.zeros(64, dtype=np.int64)
        self.permutation = np.zeros(matrix.shape[0], dtype=np.int32)
        self.options = np.zeros(64, dtype=np.int32)
        # Not the defaults but these: METIS, perturbation 1e-13, scaling, matching, count the
        # entries, indices from 0.
        given = {0: 1, 1: 2, 9: 13, 10: 1, 12: 1, 17: -1, 20: 1, 34: 1}
        for index, value in (given | settings).items():
            self.options[index] = value

    def run(self, phase: int) -> None:
        """Runs a phase; raises by its error."""
        integer = ctypes.c_int
        error = integer(0)
        self.library.pardiso(
            pointer(self.handle),
            *(ctypes.byref(integer(value)) for value in (1, 1, 11, phase)),
            ctypes.byref(integer(self.matrix.shape[0])),
            *self.arrays,
            pointer(self.permutation),
            ctypes.byref(integer(1)),
            pointer(self.options),
            ctypes.byref(integer(0)),
            pointer(self.rhs),
            pointer(self.x),
            ctypes.byref(error),
        )
        if error.value != 0:
            raise RuntimeError(f"PARDISO: phase {phase} ended with {error.value}")

    def release_analysis(self) -> None:
        """Phase -1."""
        if self.handle.any():
            self.run(-1)
            self.handle[:] = 0

    def analyse(self) -> None:
        """Phase 11."""
        self.options[17] = -1
        self.run(11)

    def factorise(self) -> None:
        """Phase 22."""
        self.run(22)

    def solve(self) -> None:
        """Phase 33."""
        self.run(33)

    def entries(self) -> int:
        """iparm[17]."""
        return int(self.options[17])

    def refinements(self) -> int:
        """iparm[6]."""
        return int(self.options[6])


class SuperLU(Solver):
    """SciPy's SuperLU, which has no analysis to reuse."""

    # Its symmetric mode took ten times as long on the flow's matrices.
    variants: ClassVar = {"COLAMD": {"permc_spec": "COLAMD"}}

    def analyse(self) -> None:
        """Nothing."""

    def factorise(self) -> None:
        """`splu`."""
        self.factors = splu(self.matrix, **self.settings)

    def solve(self) -> None:
        """Solves."""
        self.x = self.factors.solve(self.rhs)

    def entries(self) -> int:
        """Those of L and U."""
        return int(self.factors.nnz)


SOLVERS: dict[str, type[Solver]] = {
    "mumps": Mumps,
    "umfpack": Umfpack,
    "pardiso": Pardiso,
    "superlu": SuperLU,
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
