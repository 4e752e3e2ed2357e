#!/usr/bin/env bash
# Long runs: many turns, many communication steps, a long standstill, stops and starts, unwinding and rewinding.
#
#     scripts/endurance.sh [--short]
#
# Prints a line a run and exits with 1 if one does not hold. --short takes a hundredth of each, for a machine that tests.
# Runs go to target/endurance/ (or under CARGO_TARGET_DIR). Needs the command, or COILWIND_COMMAND, and Python 3.
set -uo pipefail
cd "$(dirname "$0")/.."

target=${CARGO_TARGET_DIR:-target}
command=${COILWIND_COMMAND:-$target/release/coilwind}
if [ -z "${COILWIND_COMMAND-}" ]; then
    cargo build --locked --release --bin coilwind || exit
fi
exec python3 scripts/endurance.py "$command" "$target/endurance" "$@"
