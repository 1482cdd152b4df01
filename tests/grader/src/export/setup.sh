#!/bin/sh
# Gradescope runs this once, when it makes the image. It installs a Rust toolchain and builds the kit. Grading itself needs no
# network.
set -eu
root=${AUTOGRADER_ROOT:-/autograder}
: "${HOME:=/root}"
export HOME
PATH="${CARGO_HOME:-$HOME/.cargo}/bin:$PATH"

# The compiler of submissions needs a linker.
if ! command -v cc >/dev/null || ! command -v curl >/dev/null; then
    apt-get update
    apt-get install -y --no-install-recommends build-essential ca-certificates curl
fi
if ! command -v cargo >/dev/null; then
    curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y --profile minimal
fi

cd "$root/source"
cargo build --locked --release --package grader --bin grader --package solutions --bin solutions-worker
# Build the libraries against which submissions are compiled.
cargo build --locked --package raykata --lib
# Grade the untouched exercises once: the result must be 0 points, and the log of the image shows any problem.
chmod +x run_autograder
./run_autograder exercises
cat "$root/results/results.json"
rm -f "$root/results/results.json"
