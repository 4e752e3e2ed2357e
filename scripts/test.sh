#!/usr/bin/env bash
# Every check: format, lints, documentation, packaging, exact answers, Rust tests, fmpy tests.
#
#     scripts/test.sh
#
# Needs Rust, a C linker and Python 3.10 or later. Stops at the first failure; the summaries of
# cargo test and pytest come last.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ $# -gt 0 ]; then
    echo "test.sh: unknown option $1 (there are none)" >&2
    exit 2
fi

target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)
began=$SECONDS
step() { printf '\n== %s (at %d s)\n' "$*" $((SECONDS - began)); }

step format
cargo fmt --all --check

step lints
cargo clippy --locked --workspace --all-targets -- -D warnings

step documentation
RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --no-deps --document-private-items --quiet

step command and FMU
cargo build --locked --release --bin coilwind
scripts/build_fmu.sh

step Python
python=$(scripts/venv.sh)
"$python" -m fmpy validate "$target/fmu/CoilWinding.fmu"

step exact answers
"$target/release/coilwind" verify
"$target/release/coilwind" verify --preset paper

step random scenes
"$target/release/coilwind" stress --count 100 --seed 1 --quiet --out "$target/stress" | tail -n 1

step Rust tests
cargo test --locked --workspace

step fmpy tests
exec env COILWIND_COMMAND="$target/release/coilwind" \
    COILWIND_FMU="$target/fmu/CoilWinding.fmu" \
    "$python" -m pytest -q tests/fmpy
