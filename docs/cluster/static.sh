#!/bin/sh
# Builds alewife as one file that needs nothing of the system it runs on:   docs/cluster/static.sh FILE
#
# Needs rustup and a C compiler for musl (Debian: musl-tools), and runs on any Linux of the same processor.
set -eu
target=$(uname -m)-unknown-linux-musl
export "CC_$(echo "$target" | tr - _)=musl-gcc"
cd "$(dirname "$0")/../.."
rustup target add "$target"
cargo build --release --locked --target "$target"
install -D "${CARGO_TARGET_DIR:-target}/$target/release/alewife" "$1"
