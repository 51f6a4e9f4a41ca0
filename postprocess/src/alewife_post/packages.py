"""Packages that not every installation has, and the extra of `alewife` that brings each."""

from __future__ import annotations

import importlib
from types import ModuleType

EXTRAS = {
    "pictures": ("matplotlib", "PIL", "pyvista", "vtk", "vtkmodules"),
    "film": ("imageio_ffmpeg",),
    "table": ("pandas",),
    "meshes": ("h5py", "meshio"),
}
"""The packages of each extra of `alewife`."""
SIZES = {"pictures": "835 MB, most of it VTK", "film": "903 MB, most of it VTK"}
"""What the larger extras take on the disk."""


def missing(module: str) -> str:
    """That a package is missing, and what brings it."""
    package = module.partition(".")[0]
    extra = next((extra for extra, of in EXTRAS.items() if package in of), None)
    remedy = f"'alewife[{extra}]'" if extra else "alewife"
    size = f" ({SIZES[extra]})" if extra in SIZES else ""
    return f"the package {package} is not installed: pip install {remedy}{size}"


def needed(name: str) -> ModuleType:
    """A package that may be missing; ModuleNotFoundError says what brings it."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        module = error.name or name
        raise ModuleNotFoundError(missing(module), name=module) from error
