#!/usr/bin/env bash
# Builds everything and winds Fig. 8 of the paper at four speeds through the FMU, driven by fmpy.
#
#     scripts/demo.sh [--turns T] [--speeds RAD/S...] [--jobs N]
#
# Then it winds fig8_gap, which has half the traverse, at these speeds and a bobbin with four layers by the command. Prints
# progress and the verdict table; leaves CSV, pictures, a report of each run (target/demo/SPEED/report.html,
# target/demo/fig8_gap/SPEED/report.html, target/demo/bobbin/report.html) and target/demo/index.html, which leads to them.
# Needs Rust, a C linker and Python 3.10 or later. --turns 0.5 gives a quick look (the full job is 2.5 turns, so that the second
# comes to rest), --speeds fewer or other speeds, --no-bobbin leaves out the bobbin, --jobs the runs at a time (2). Ctrl-C ends
# the runs early and reports on what they have wound.
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1-} in
    -h | --help)
        sed -n '2,/^set /{/^#/!d;s/^# \{0,1\}//;p}' scripts/demo.sh
        exit
        ;;
esac

target=${CARGO_TARGET_DIR:-target}
echo "building the FMU"
scripts/build_fmu.sh
echo "building the command, which makes the reports"
cargo build --locked --release --bin coilwind
python=$(scripts/venv.sh)
# Each run is one thread; linear algebra libraries must not spread over the other's core.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# What an earlier demonstration left would mix with this one.
rm -rf "$target/demo"
exec "$python" scripts/demo.py --fmu "$target/fmu/CoilWinding.fmu" --command "$target/release/coilwind" --out "$target/demo" "$@"
