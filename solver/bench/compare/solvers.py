"""Wrappers of direct solvers for sparse linear systems: MUMPS, UMFPACK, PARDISO and SuperLU."""

import ctypes
import ctypes.util
import subprocess
import sys
import tempfile
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

Settings = dict[str, Any]


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
