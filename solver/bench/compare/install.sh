#!/bin/sh
# Installs what compare.py needs: Debian's MUMPS and UMFPACK, and a Python environment with
# NumPy, SciPy and MKL. The one argument, optional, is the environment's folder.
set -eu
environment=${1:-"$(dirname "$0")/.venv"}
as_root=
[ "$(id -u)" -eq 0 ] || as_root=sudo
$as_root apt-get update -q
$as_root apt-get install -y -q --no-install-recommends \
    gcc libc6-dev python3-venv libmumps-seq-dev libsuitesparse-dev libopenblas0-pthread
python3 -m venv "$environment"
"$environment/bin/pip" install -q numpy scipy mkl
echo "run: $environment/bin/python $(dirname "$0")/compare.py FOLDER..."
