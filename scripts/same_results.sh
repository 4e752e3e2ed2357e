#!/usr/bin/env bash
# Winds a fixed set of runs and compares what they compute, to the bit, with tests/golden/results.json.
#
#     scripts/same_results.sh [--record] [--only WORD]
#
# Set: fig8 at four speeds, fig8_gap, both explicit methods, every scene under tests/stress, 40 random scenes, and
# all exact answers. Takes about two minutes. --record writes the file anew: do that only in a commit that says which results
# change and why. COILWIND_COMMAND names another binary than target/release/coilwind; without it that one is built.
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1-} in
    -h | --help)
        sed -n '2,/^set /{/^#/!d;s/^# \{0,1\}//;p}' scripts/same_results.sh
        exit
        ;;
esac
target=${CARGO_TARGET_DIR:-target}
[ -n "${COILWIND_COMMAND-}" ] || cargo build --locked --release --bin coilwind
exec "$(scripts/venv.sh)" scripts/same_results.py --command "${COILWIND_COMMAND:-$target/release/coilwind}" "$@"
