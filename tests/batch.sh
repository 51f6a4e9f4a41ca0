# What the scripts that run the program under other programs have in common: rows of verdicts, a case, and bits of runs.
# Sourced by container.sh and slurm.sh.

failures=0
accurate='{ tolerance = 5e-3, largest = 0.005 }'

# NAME, whether it is so, and what was found.
row() {
    local verdict=passed
    [ "$2" = 0 ] || { verdict=FAILED; failures=$((failures + 1)); }
    printf '%-66s %s  %s\n' "$1" "$verdict" "${3:-}"
}

# How it ends, with the exit code.
tell_failures() {
    echo
    if [ $failures = 0 ]; then echo "all passed"; else echo "$failures failed"; exit 1; fi
}

# A case with contact and remeshing in a FILE, up to a time END, with steps by the settings ADAPTIVE.
case_file() {
    cat >"$1" <<CASE
title = 'a disc that settles on the bottom'
geometry = 'planar'
fluid = { model = 'navier-stokes', density = 1.0, viscosity = 0.1, gravity = [0.0, -10.0] }
domain.box = { min = [-1.0, -1.0], max = [1.0, 1.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 0.1, surface = 0.03 }
output.checkpoint = { wall = '1 s', keep = 2 }
output.fields = { time = 0.5 }
contact.barrier = { range = 0.1, stiffness = 50.0 }
time.unsteady = { step = 0.005, end = $2, adaptive = $3 }
[[body]]
name = 'disc'
shape.disc.radius = 0.2
center = [0.1, 0.2]
density = 2.0
motion = 'free'
CASE
}

# Whether two runs left the same bits: series, last state, every field file and their list.
same_bits() {
    local one=$1 other=$2 last
    last=$(cd "$other/checkpoints" && ls | tail -1)
    cmp "$one/series.csv" "$other/series.csv" && cmp "$one/fields.pvd" "$other/fields.pvd" &&
        cmp "$one/checkpoints/$last" "$other/checkpoints/$last" && diff -r "$one/fields" "$other/fields"
}

# NAME, a run, and an unbroken one.
compare() {
    local told
    told=$(same_bits "$2" "$3" 2>&1) && row "$1" 0 || row "$1" 1 "$told"
}
