#!/bin/sh
# Builds the shared library for this machine and packs target/fmu/CoilWinding.fmu.
set -eu

if [ $# -gt 0 ]; then
    echo "build_fmu.sh: unknown option $1 (there are none yet)" >&2
    exit 2
fi

cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target}

# One call, so that the packages build side by side.
cargo build --locked --release --package coilwind-fmu --package coilwind-model-description

case $(uname -s) in
    Darwin) library=$target/release/libCoilWinding.dylib ;;
    MINGW* | MSYS*) library=$target/release/CoilWinding.dll ;;
    *) library=$target/release/libCoilWinding.so ;;
esac

"$target/release/pack-fmu" "$library" "$target/fmu/CoilWinding.fmu" src/scene/packed
