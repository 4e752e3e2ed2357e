#!/usr/bin/env bash
# Every check: format, lints, documentation, packaging, exact answers, random scenes, whether the benchmarks run, Rust tests,
# tests of the FMU.
#
#     scripts/test.sh
#
# Needs Rust, a C linker and Python 3.10 or later. Stages that need more say SKIPPED, with what is
# missing, where it is not there; scripts/install_tools.sh installs it. Stops at the first failure;
# the summaries of cargo test and pytest come last.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ $# -gt 0 ]; then
    echo "test.sh: unknown option $1 (there are none)" >&2
    exit 2
fi

target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)
began=$SECONDS
skipped=
skip() {
    printf '\n== SKIPPED %s, because on this machine\n%s\n' "$1" "$2"
    skipped+=$(printf 'SKIPPED %s:\n%s' "$1" "$2")$'\n'
}
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

missing=$(scripts/missing_tools.sh portable)
if [ -z "$missing" ]; then
    # From here on the FMU is the portable one.
    step portable FMU
    scripts/build_fmu.sh --portable
    step portable FMU from another directory
    scripts/check_reproducible.sh
else
    skip "portable FMU" "$missing"
fi

step Python
python=$(scripts/venv.sh)
"$python" -m fmpy validate "$target/fmu/CoilWinding.fmu"
# Where their packages cannot run they need not be fetched; the tests say so.
importers=
if [ -z "$(scripts/missing_tools.sh importers)" ]; then importers=$(scripts/venv.sh importers); fi

step exact answers
"$target/release/coilwind" verify
"$target/release/coilwind" verify --preset paper

step random scenes
"$target/release/coilwind" stress --count 100 --seed 1 --quiet --out "$target/stress" | tail -n 1

step benchmarks at their coarsest
log=$target/bench-quick.log
if ! COILWIND_COMMAND="$target/release/coilwind" COILWIND_FMU="$target/fmu/CoilWinding.fmu" \
    scripts/bench.sh --quick >"$log" 2>&1; then
    tail -n 40 "$log"
    exit 1
fi
tail -n 1 "$log"

step Rust tests
cargo test --locked --workspace

step tests of the FMU
for stage in c sanitizer valgrind wine importers; do
    missing=$(scripts/missing_tools.sh $stage)
    if [ -n "$missing" ]; then skip "tests that need: $stage" "$missing"; fi
done
if [ -n "$skipped" ]; then printf '\nNot everything is tested here.\n%s' "$skipped"; fi
# -rs names the tests that were skipped, with the reason.
exec env COILWIND_COMMAND="$target/release/coilwind" \
    COILWIND_FMU="$target/fmu/CoilWinding.fmu" \
    COILWIND_IMPORTERS_PYTHON="$importers" \
    "$python" -m pytest -q -rs tests/fmpy
