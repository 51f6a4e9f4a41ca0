#!/bin/bash
# Fifty trials of 2, 4 and 8 processes on one sweep, the first of them killed in each: all points are made once, and all
# that are not killed end with 0. Daily: `processes_on_one_sweep_do_each_point_once_though_some_are_killed`.
# Usage: tests/sweep_trials.sh [PROGRAM]
set -u
program=$(realpath "${1:-target/release/alewife}")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place" || exit 1
good=0
for trial in $(seq 1 50); do
    n=$((2 ** (1 + trial % 3)))
    processes=()
    for _ in $(seq 1 "$n"); do
        "$program" sweep run squirmer-alone --set mesh.scale=2 --set body.0.gait.squirmer.modes.1=0:5:6 \
            --out s --jobs 1 --quiet > /dev/null 2>> told &
        processes+=($!)
    done
    sleep "0.$(((trial * 37) % 90 + 10))"
    kill -9 "${processes[0]}" 2> /dev/null
    wait "${processes[0]}" 2> /dev/null
    codes=""
    for process in "${processes[@]:1}"; do
        wait "$process"
        codes="$codes $?"
    done
    finished=$(cut -d, -f3 s/sweep.csv | grep -c finished)
    once=0
    for point in s/points/*; do
        twice=$(tail -n +2 "$point/series.csv" | cut -d, -f1 | sort | uniq -d | wc -l)
        [ "$twice" = 0 ] && once=$((once + 1))
    done
    if [ -z "$(echo "$codes" | tr -d ' 0')" ] && [ "$finished" = 6 ] && [ "$once" = 6 ]; then
        good=$((good + 1))
    else
        echo "trial $trial: $n processes, codes$codes, $finished finished, $once without a row twice"
        cat told
    fi
    rm -rf s told
done
echo "$good of 50 trials"
[ "$good" = 50 ]
