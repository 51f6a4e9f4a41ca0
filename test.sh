#!/usr/bin/env bash
# Runs every test of the project: Rust, then Python.
#
# Needs Rust and Python 3.11 or later; installs what else it needs: OSMesa for pictures without a
# display (Debian package libosmesa6, asked for only where missing) and a virtual environment in
# target/venv.
set -euo pipefail
cd "$(dirname "$0")"

install_system_packages() {
    if ldconfig -p | grep -q libOSMesa && python3 -c "import ensurepip" 2>/dev/null; then return; fi
    command -v apt-get >/dev/null || { echo "note: no OSMesa; pictures need a display" >&2; return; }
    local as_root=()
    [ "$(id -u)" = 0 ] || as_root=(sudo)
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" apt-get install -y -qq --no-install-recommends libosmesa6 python3-venv >/dev/null
}

install_system_packages
cargo test --release --workspace

venv=target/venv
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
"$venv/bin/pip" install --quiet --disable-pip-version-check --editable '.[test]'
export ALEWIFE_BIN="$PWD/target/release/alewife" VTK_DEFAULT_OPENGL_WINDOW=vtkOSOpenGLRenderWindow
"$venv/bin/python" -m pytest --numprocesses "$(nproc)"
