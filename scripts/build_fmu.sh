#!/usr/bin/env bash
# Builds the shared library and packs target/fmu/CoilWinding.fmu.
#
#     scripts/build_fmu.sh               for this machine only; needs Rust and a C linker
#     scripts/build_fmu.sh --portable    linux64 for glibc 2.17 or later and win64, the same bytes
#                                        from the same sources wherever they lie
#
# What --portable needs besides is said by scripts/missing_tools.sh portable. COILWIND_PACK_FMU names a pack-fmu that is
# built already.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)
out=$target/fmu/CoilWinding.fmu

portable=false
case "$#:${1-}" in
    0:) ;;
    1:--portable) portable=true ;;
    *)
        echo "build_fmu.sh: unknown option $* (there is --portable)" >&2
        exit 2
        ;;
esac

if ! $portable; then
    # As a shared library alone: together with the Rust library that the tests use there is no
    # link-time optimisation.
    cargo rustc --locked --release --package coilwind-fmu --lib --crate-type cdylib
    cargo build --locked --release --package coilwind-model-description
    case $(uname -s) in
        Darwin) library=$target/release/libCoilWinding.dylib ;;
        MINGW* | MSYS*) library=$target/release/CoilWinding.dll ;;
        *) library=$target/release/libCoilWinding.so ;;
    esac
    exec "$target/release/pack-fmu" "$out" "$library"
fi

missing=$(scripts/missing_tools.sh portable)
if [ -n "$missing" ]; then
    printf 'build_fmu.sh: --portable is not possible on this machine:\n%s\n' "$missing" >&2
    exit 1
fi
tools=$(cd "$(dirname "$(scripts/venv.sh build)")" && pwd)

# No path of this machine may reach the libraries: not of the sources, of the crates, of what is
# generated while building, nor of the standard library's sources where they are installed.
crates=${CARGO_HOME:-$HOME/.cargo}
std=$(rustc --print sysroot)/lib/rustlib/src/rust
commit=$(rustc --version --verbose | sed -n 's/^commit-hash: //p')
flags=(
    "--remap-path-prefix=$PWD=/coilwind"
    "--remap-path-prefix=$target=/target"
    "--remap-path-prefix=$crates=/cargo"
    "--remap-path-prefix=$std=/rustc/$commit"
    -Cstrip=symbols
    -Ctarget-cpu=x86-64
)
separated() { local IFS=$'\x1f'; echo "$*"; }

build=(rustc --locked --release --package coilwind-fmu --lib --crate-type cdylib)

# Target directories of their own, so that the flags above do not throw out what other builds have left; one for each
# library, so that the two are built side by side: link-time optimisation keeps a single core busy.
export CARGO_INCREMENTAL=0
linux=x86_64-unknown-linux-gnu
windows=x86_64-pc-windows-gnu

echo "linux64, for glibc 2.17, and win64"
# zig brings the symbol tables of old glibc versions; cargo-zigbuild finds it through python's path.
CARGO_TARGET_DIR=$target/portable/linux CARGO_ENCODED_RUSTFLAGS=$(separated "${flags[@]}") PATH=$tools:$PATH \
    cargo-zigbuild "${build[@]}" --target $linux.2.17 &
building=$!
# An error here or Ctrl-C ends the other build too.
trap 'kill $building 2>/dev/null || true' EXIT

# Not zig: it exports what is internal. Without a time in the header the same code gives the same bytes.
CARGO_ENCODED_RUSTFLAGS=$(separated "${flags[@]}" -Clink-arg=-Wl,--no-insert-timestamp) \
    CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER=$PWD/scripts/link_dll.sh \
    CARGO_TARGET_DIR=$target/portable/windows COILWIND_TARGET=$target/portable/windows \
    COILWIND_CRATES=$crates COILWIND_TOOLCHAIN=$(rustc --print sysroot) \
    cargo "${build[@]}" --target $windows
wait $building
trap - EXIT

so=$target/portable/linux/$linux/release/libCoilWinding.so
dll=$target/portable/windows/$windows/release/CoilWinding.dll
scripts/check_library.sh --glibc 2.17 "$so"
scripts/check_library.sh "$dll"

if [ -z "${COILWIND_PACK_FMU-}" ]; then
    COILWIND_PACK_FMU=$target/release/pack-fmu
    cargo build --locked --release --package coilwind-model-description
fi
exec "$COILWIND_PACK_FMU" "$out" "$so" "$dll"
