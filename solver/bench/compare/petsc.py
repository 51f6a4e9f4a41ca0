"""Solves the systems of `spatial.rs` by PETSc: Stokes flow in a box of tetrahedra under a lid.

    cargo bench -p benches --bench spatial -- --write "$PWD/boxes" 9 15 18 27
    sh solver/bench/compare/install_petsc.sh
    /usr/bin/python3 solver/bench/compare/petsc.py boxes/*

Each folder has one system: `columns.npy`, `rows.npy`, `values.npy` (compressed columns), `rhs.npy`,
`nodes.npy` and `is_pressure.npy` of the unknowns, and the mesh in `cells.npy` and `points.npy`.

Velocities and pressures are two fields. The preconditioner is upper block-triangular: one cycle of
algebraic multigrid for the velocities (three to a node), and the mass matrix of the pressures over
twice the viscosity by four steps of Chebyshev's iteration. MINRES has a block-diagonal one. The table
shows CPU seconds of set-up and solution, from zero to 1e-8 of the right-hand side in the Euclidean
norm of the residual, one setting in a process of its own, the least of two.
"""

import glob
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sparse

TOLERANCE = 1e-8
REPEATS = 2

SETTINGS = {
    "FGMRES, GAMG": ("fgmres", "gamg", False, {}),
    "FGMRES, GAMG, rigid motions": ("fgmres", "gamg", True, {}),
    "FGMRES, GAMG, rigid motions, four sweeps": (
        "fgmres",
        "gamg",
        True,
        {"fieldsplit_u_mg_levels_ksp_max_it": "4", "fieldsplit_u_pc_gamg_threshold": "0.01"},
    ),
    "FGMRES, BoomerAMG by node": (
        "fgmres",
        "hypre",
        False,
        {
            "fieldsplit_u_pc_hypre_boomeramg_numfunctions": "3",
            "fieldsplit_u_pc_hypre_boomeramg_strong_threshold": "0.5",
        },
    ),
    "FGMRES, BoomerAMG by node, HMIS": (
        "fgmres",
        "hypre",
        False,
        {
            "fieldsplit_u_pc_hypre_boomeramg_numfunctions": "3",
            "fieldsplit_u_pc_hypre_boomeramg_strong_threshold": "0.25",
            "fieldsplit_u_pc_hypre_boomeramg_coarsen_type": "HMIS",
            "fieldsplit_u_pc_hypre_boomeramg_interp_type": "ext+i",
            "fieldsplit_u_pc_hypre_boomeramg_P_max": "4",
        },
    ),
    "MINRES, GAMG, rigid motions": ("minres", "gamg", True, {}),
}
"""Krylov method, multigrid, whether it knows rigid motions, and more options."""


def load(folder: Path) -> dict[str, np.ndarray]:
    """The arrays of a folder."""
    return {path.stem: np.load(path) for path in folder.glob("*.npy")}


def pressure_mass(data: dict[str, np.ndarray], nodes: np.ndarray) -> sparse.csr_matrix:
    """The mass matrix of linear pressures on straight tetrahedra, of the nodes with an unknown."""
    cells = data["cells"].reshape(-1, 4).astype(int)
    points = data["points"].reshape(-1, 3)
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    volumes = np.abs(np.linalg.det(edges)) / 6
    local = (np.ones((4, 4)) + np.eye(4)) / 20
    values = (volumes[:, None, None] * local).ravel()
    rows = np.repeat(cells, 4, axis=1).ravel()
    columns = np.tile(cells, (1, 4)).ravel()
    n = len(points)
    return sparse.csr_matrix((values, (rows, columns)), shape=(n, n))[nodes][:, nodes].tocsr()


def solve(folder: Path, name: str) -> dict[str, float]:
    """Solves one system by one setting."""
    sys.path += glob.glob("/usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages")
    import petsc4py

    petsc4py.init(["petsc", "-options_left", "no"])
    from petsc4py import PETSc

    krylov, multigrid, has_rigid, more = SETTINGS[name]
    data = load(folder)
    n = len(data["rhs"])
    columns, rows = (data[key].astype(np.int32) for key in ("columns", "rows"))
    # Symmetric: columns are rows
    matrix = sparse.csr_matrix((data["values"], rows, columns), shape=(n, n))
    is_pressure = data["is_pressure"].astype(bool)
    velocities, pressures = np.flatnonzero(~is_pressure), np.flatnonzero(is_pressure)
    order = np.concatenate([velocities, pressures])
    matrix = matrix[order][:, order].tocsr()
    matrix.sort_indices()
    rhs = data["rhs"][order]
    n_u = len(velocities)
    mass = pressure_mass(data, data["nodes"][pressures].astype(int))

    def petsc_matrix(values: sparse.spmatrix, block: int) -> PETSc.Mat:
        rows = values.tocsr()
        new = PETSc.Mat().createAIJ(
            rows.shape, csr=(rows.indptr, rows.indices, rows.data), comm=PETSc.COMM_SELF
        )
        new.setBlockSize(block)
        return new

    zero = sparse.csr_matrix(mass.shape)
    blocks = [
        [petsc_matrix(matrix[:n_u, :n_u], 3), petsc_matrix(matrix[:n_u, n_u:], 1)],
        [petsc_matrix(matrix[n_u:, :n_u], 1), petsc_matrix(zero, 1)],
    ]
    # Twice the viscosity, which is one; MINRES wants it positive, the triangular one negative
    schur = petsc_matrix(mass * (0.5 if krylov == "minres" else -0.5), 1)
    if has_rigid:
        nodes = data["nodes"][velocities].astype(int)[::3]
        coordinates = PETSc.Vec().createWithArray(
            data["points"].reshape(-1, 3)[nodes].ravel().copy(), bsize=3, comm=PETSc.COMM_SELF
        )
        blocks[0][0].setNearNullSpace(PETSc.NullSpace().createRigidBody(coordinates))
    whole = petsc_matrix(matrix, 1)
    options = PETSc.Options()
    for key, value in {
        "fieldsplit_u_ksp_type": "preonly",
        "fieldsplit_u_pc_type": multigrid,
        "fieldsplit_p_ksp_type": "chebyshev",
        "fieldsplit_p_ksp_max_it": "4",
        "fieldsplit_p_ksp_chebyshev_eigenvalues": "0.5,2.5",
        "fieldsplit_p_pc_type": "jacobi",
    }.items():
        options[key] = value
    for key, value in more.items():
        options[key] = value

    begin = time.process_time()
    inner = []
    for prefix, operator in (("fieldsplit_u_", blocks[0][0]), ("fieldsplit_p_", schur)):
        ksp = PETSc.KSP().create(PETSc.COMM_SELF)
        ksp.setOptionsPrefix(prefix)
        ksp.setOperators(operator)
        ksp.setFromOptions()
        if prefix == "fieldsplit_p_":
            ksp.setNormType(PETSc.KSP.NormType.NONE)
        ksp.setUp()
        inner.append(ksp)
    set_up = time.process_time() - begin

    class Triangular:
        """[F G; 0 -S], or its diagonal for MINRES."""

        def __init__(self) -> None:
            self.u, self.ru = blocks[0][0].createVecs()
            self.p, self.rp = schur.createVecs()

        def apply(self, _: PETSc.PC, r: PETSc.Vec, z: PETSc.Vec) -> None:
            with r as values:
                self.ru.array[:] = values[:n_u]
                self.rp.array[:] = values[n_u:]
            inner[1].solve(self.rp, self.p)
            if krylov != "minres":
                blocks[0][1].mult(self.p, self.u)
                self.ru.axpy(-1.0, self.u)
            inner[0].solve(self.ru, self.u)
            z.array[:n_u] = self.u.array_r
            z.array[n_u:] = self.p.array_r

    outer = PETSc.KSP().create(PETSc.COMM_SELF)
    outer.setOperators(whole)
    outer.setType(krylov)
    if krylov == "fgmres":
        outer.setGMRESRestart(200)
    # MINRES has the residual in the norm of its preconditioner
    outer.setTolerances(rtol=TOLERANCE if krylov == "fgmres" else 0.1 * TOLERANCE, max_it=400)
    outer.getPC().setType("python")
    outer.getPC().setPythonContext(Triangular())
    outer.setUp()
    b = PETSc.Vec().createWithArray(rhs, comm=PETSc.COMM_SELF)
    x = b.duplicate()
    begin = time.process_time()
    outer.solve(b, x)
    seconds = time.process_time() - begin
    residual = np.linalg.norm(rhs - matrix @ x.array_r) / np.linalg.norm(rhs)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    return {
        "n": n,
        "iterations": outer.getIterationNumber(),
        "set_up": set_up,
        "solve": seconds,
        "residual": float(residual),
        "peak": peak,
    }


def main() -> None:
    """Prints a table of all settings on all systems."""
    if sys.argv[1] == "--one":
        print(json.dumps(solve(Path(sys.argv[2]), sys.argv[3])))
        return
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    print("| Unknowns | PETSc | Iterations | Set-up s | Solve s | Residual |")
    print("|---:|---|---:|---:|---:|---:|")
    for folder in sorted(sys.argv[1:], key=lambda path: len(np.load(f"{path}/rhs.npy"))):
        for name in SETTINGS:
            rows = []
            for _ in range(REPEATS):
                command = [sys.executable, __file__, "--one", folder, name]
                run = subprocess.run(command, env=environment, capture_output=True, text=True)
                if run.returncode != 0:
                    print(name, "failed:", run.stderr.strip().splitlines()[-1:], file=sys.stderr)
                    break
                rows.append(json.loads(run.stdout))
            if rows:
                best = min(rows, key=lambda row: row["set_up"] + row["solve"])
                print(
                    f"| {best['n']} | {name} | {best['iterations']} | {best['set_up']:.2f} | "
                    f"{best['solve']:.2f} | {best['residual']:.0e} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
