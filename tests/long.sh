#!/usr/bin/env bash
# Runs the long tests, which `cargo test` leaves out: hours. `tests/long.sh NAME...` runs those
# whose path has one of the names.
#
# A long test says so, and names a small one of the same fault that runs daily:
#     #[ignore = "long: two hours; small: walks_near_contact_get_all_the_meshes_they_need"]
# An attribute and no feature of the packages: with a feature of its own `alewife-mesh`, and all that
# use it would be compiled a second time. tests/architecture checks the names.
set -euo pipefail
cd "$(dirname "$0")/.."
exec cargo test --release --workspace --exclude benches --tests --no-fail-fast -- \
    --ignored --nocapture "$@"
