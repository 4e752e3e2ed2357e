#!/usr/bin/env bash
# Fuzzes what reads bytes from outside: scene files, STL files, serialised states.
#
#     scripts/fuzz.sh scene | stl | state [SECONDS]
#
# Needs a nightly Rust and cargo-fuzz (cargo install cargo-fuzz). Starts from fuzz/corpus, keeps what
# it finds in target/fuzz; a failure prints the file that caused it and how to run it again. The same
# entries run on spoilt good files with every cargo test (tests/arbitrary_files.rs,
# fmu/tests/arbitrary_states.rs).
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)

case ${1-} in
    scene | stl | state) ;;
    *)
        echo "usage: scripts/fuzz.sh scene | stl | state [SECONDS]" >&2
        exit 2
        ;;
esac
if ! cargo +nightly --version >/dev/null 2>&1 || ! cargo fuzz --version >/dev/null 2>&1; then
    echo "fuzz.sh: needs a nightly Rust (rustup toolchain install nightly) and cargo-fuzz (cargo install cargo-fuzz)" >&2
    exit 1
fi
found=$target/fuzz/corpus/$1
mkdir -p "$found" "$target/fuzz/artifacts/$1"
unset CARGO_TARGET_DIR
exec cargo +nightly fuzz run --target-dir "$target/fuzz/build" "$1" "$found" "fuzz/corpus/$1" -- \
    -max_total_time="${2:-60}" -artifact_prefix="$target/fuzz/artifacts/$1/"
