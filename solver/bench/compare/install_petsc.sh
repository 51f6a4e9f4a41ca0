#!/bin/sh
# Installs what petsc.py needs: Debian's PETSc with its Python bindings, NumPy and SciPy.
set -eu
as_root=
[ "$(id -u)" -eq 0 ] || as_root=sudo
$as_root apt-get update -q
$as_root apt-get install -y -q --no-install-recommends \
    python3-petsc4py-real python3-numpy python3-scipy
echo "run: /usr/bin/python3 $(dirname "$0")/petsc.py FOLDER..."
