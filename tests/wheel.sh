#!/usr/bin/env bash
# Installs alewife in every way the pages name, each in an empty environment, and follows docs/start.md there.
#
#   tests/wheel.sh            # about ten minutes on two cores; not part of test.sh
#
# Needs Rust, Python 3.11 or later and a network. Builds the wheel and the source distribution; installs the wheel
# with pip and with uvx, the source distribution with pip, the clone with cargo. In each it counts the shipped cases,
# runs the commands of "A first run" of docs/start.md, and prints what everything took (s on the clock).
# Everything lies in a temporary folder, or in ALEWIFE_WHEEL_PLACE, which is kept.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
if [ -n "${ALEWIFE_WHEEL_PLACE:-}" ]; then
    place=$ALEWIFE_WHEEL_PLACE
    mkdir -p "$place"
    rm -rf "$place/dist" "$place"/in-*
else
    place=$(mktemp -d "${TMPDIR:-/tmp}/alewife-wheel.XXXXXX")
    trap 'rm -rf "$place"' EXIT
fi
log=$place/log
: >"$log"
failures=0

# NAME COMMAND...: runs it with its output in the log, and prints what it took.
row() {
    local name=$1 begin=$SECONDS verdict=passed
    shift
    echo "== $name" >>"$log"
    # Each command of a function counts, which it does not in a condition
    set +e
    (set -e; "$@") >>"$log" 2>&1
    local code=$?
    set -e
    [ $code = 0 ] || { verdict=FAILED; failures=$((failures + 1)); }
    printf '%-52s %s %5d s\n' "$name" "$verdict" $((SECONDS - begin))
    [ $code = 0 ] || { tail -20 "$log" | sed 's/^/    /'; return 0; }
}

# The commands below a heading of docs/start.md.
commands() {
    awk -v heading="## $1" '$0 == heading { here = 1; next } /^## / { here = 0 }
        here && /^```sh$/ { block = 1; next } /^```$/ { block = 0 } here && block' "$root/docs/start.md"
}

# Whether the first `alewife` of the path holds all cases and does what the page says, in a new folder.
follow() {
    local folder=$place/in-$1
    rm -rf "$folder"
    mkdir "$folder"
    cd "$folder"
    [ "$(alewife list | wc -l)" = "$(ls "$root"/cases/*/case.toml | wc -l)" ]
    commands "A first run" >commands.sh
    [ "$(grep -c '^alewife ' commands.sh)" -ge 2 ]
    bash -euo pipefail commands.sh
    grep -q '"state": "finished"' runs/three-sphere/status.json
    # A case whose mesh is a file beside it
    alewife check vessel
}

# The Python packages, what is installed beside them, and the one line that says what is not.
python_part() {
    local bin=$1/bin
    "$bin/python" - <<'PYTHON'
import alewife
from alewife_post import open_run

run = alewife.load("squirmer-alone").set("mesh.scale", 2).run(threads=1)
assert abs(run.quantities["squirmer.velocity.x"] - 1) < 0.01, run.quantities
assert open_run(run.path).status["state"] == "finished"
# What a report carries lies beside its code
from importlib.resources import files

for name in ("three.min.js", "three.LICENSE", "viewer.js", "page.css"):
    assert (files("alewife_post") / "browser" / name).is_file(), name
PYTHON
    cmp "$1/share/man/man1/alewife-run.1" "$root/postprocess/commands/data/share/man/man1/alewife-run.1"
    local said code=0
    said=$("$bin/alewife-post" picture nowhere --out a.png 2>&1) || code=$?
    echo "alewife-post: code $code, $said"
    [ $code = 2 ]
    [ "$(wc -l <<<"$said")" = 1 ]
    grep -q "matplotlib is not installed: pip install 'alewife\[pictures\]'" <<<"$said"
}

# NAME FILE: a new environment with nothing but that file and what it needs.
with_pip() {
    local venv=$place/in-$1-venv
    python3 -m venv "$venv"
    "$venv/bin/pip" install --disable-pip-version-check "$2"
}

in_venv() {
    local venv=$place/in-$1-venv
    export PATH=$venv/bin:$PATH
    follow "$1"
    python_part "$venv"
}

with_uvx() {
    mkdir -p "$place/in-uvx"
    cd "$place/in-uvx"
    # Its own folders, that nothing else of uv is used
    export UV_CACHE_DIR=$place/in-uv-cache UV_TOOL_DIR=$place/in-uv-tools
    "$place/tools/bin/uvx" --from "$1" alewife run three-sphere
    grep -q '"state": "finished"' runs/three-sphere/status.json
}

with_cargo() { cargo install --path "$root/solver" --root "$place/in-cargo-root"; }
in_cargo() { PATH=$place/in-cargo-root/bin:$PATH; follow cargo; }

tools() { python3 -m venv "$place/tools" && "$place/tools/bin/pip" install --disable-pip-version-check 'maturin>=1.9,<2' uv; }
build() { cd "$root" && "$place/tools/bin/maturin" "$@" --out "$place/dist"; }

[ -x "$place/tools/bin/uvx" ] || row "maturin and uv" tools
row "build the source distribution" build sdist
row "build the wheel" build build --release
wheel=$(compgen -G "$place/dist/alewife-*.whl" || true)
sdist=$(compgen -G "$place/dist/alewife-*.tar.gz" || true)
row "pip install the wheel" with_pip wheel "$wheel"
row "the wheel: cases, first run, Python, manual" in_venv wheel
row "uvx --from the wheel alewife run three-sphere" with_uvx "$wheel"
row "pip install the source distribution" with_pip sdist "$sdist"
row "the source distribution: the same" in_venv sdist
row "cargo install --path solver" with_cargo
row "cargo: cases and first run" in_cargo
du -sh "$wheel" "$sdist" "$place/in-wheel-venv" | awk '{ print $1, $2 }'
[ $failures = 0 ] && echo "all passed" || { echo "$failures failed"; exit 1; }
