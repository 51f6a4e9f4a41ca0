#!/usr/bin/env bash
# Runs the tests of the project: `./test.sh rust`, `./test.sh python`, or both without a name.
#
# Needs Rust and Python 3.11 or later. Those in Python install what else they need: OSMesa for
# pictures without a display (Debian package libosmesa6, asked for only where missing) and a virtual
# environment in target/venv. They call the program that ALEWIFE_BIN names, or build it. Long tests
# are in tests/long.sh.
set -euo pipefail
cd "$(dirname "$0")"

rust() {
    # Benchmarks and examples are compiled by lints
    cargo test --release --workspace --exclude benches --tests
    # No other library has code in its comments. The sessions have no tests, but ask for features of
    # packages below all: without them everything would be compiled again
    cargo test --release -p alewife -p alewife-mesh -p alewife-session --doc
}

install_system_packages() {
    if ldconfig -p | grep -q libOSMesa && python3 -c "import ensurepip" 2>/dev/null; then return; fi
    command -v apt-get >/dev/null || { echo "note: no OSMesa; pictures need a display" >&2; return; }
    local as_root=()
    [ "$(id -u)" = 0 ] || as_root=(sudo)
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" apt-get install -y -qq --no-install-recommends libosmesa6 python3-venv >/dev/null
}

python() {
    install_system_packages
    # With the extension module of sessions, which lies beside the program
    [ -n "${ALEWIFE_BIN-}" ] || cargo build --release -p alewife -p alewife-session
    export ALEWIFE_BIN=${ALEWIFE_BIN-$PWD/target/release/alewife}
    export VTK_DEFAULT_OPENGL_WINDOW=vtkOSOpenGLRenderWindow
    [ -x target/venv/bin/python ] || python3 -m venv target/venv
    target/venv/bin/python postprocess/tests/environment.py
    target/venv/bin/python -m pytest --numprocesses "$(nproc)"
}

[ $# -gt 0 ] || set -- rust python
for what; do
    case $what in
    rust | python) "$what" ;;
    *) echo "nothing is called $what; there are: rust python" >&2; exit 2 ;;
    esac
done
