#!/usr/bin/env bash
# Error against CPU time: coilwind and, on the same problems, Exudyn, MuJoCo and PyElastica.
#
#     scripts/bench.sh [--quick]
#
# Leaves JSON lines, CSV and pictures in target/bench/, and writes the tables docs/validation/tables/performance-*.md and the
# pictures in docs/validation/performance/.
# Takes some ten minutes, one thread at a time; let the machine do nothing else. --quick: coarsest settings, once each,
# in less than five minutes, to see that everything works; nothing under docs/ is touched. COILWIND_COMMAND names another binary
# than target/release/coilwind, COILWIND_FMU another FMU; without them both are built.
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1-} in
    '' | --quick) ;;
    -h | --help)
        sed -n '2,/^set /{/^#/!d;s/^# \{0,1\}//;p}' scripts/bench.sh
        exit
        ;;
    *)
        echo "bench.sh: unknown option $1 (there is --quick)" >&2
        exit 2
        ;;
esac

target=${CARGO_TARGET_DIR:-target}
command=${COILWIND_COMMAND:-$target/release/coilwind}
fmu=${COILWIND_FMU:-$target/fmu/CoilWinding.fmu}
[ -n "${COILWIND_COMMAND-}" ] || cargo build --locked --release --bin coilwind
[ -n "${COILWIND_FMU-}" ] || scripts/build_fmu.sh
python=$(scripts/venv.sh)
peers=$(scripts/venv.sh bench)
# one thread each
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1 NUMBA_NUM_THREADS=1
exec "$python" scripts/bench/main.py --command "$command" --fmu "$fmu" --peers "$peers" --out "$target/bench" "$@"
