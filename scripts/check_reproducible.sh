#!/usr/bin/env bash
# Builds the portable FMU once more from a copy of the sources elsewhere and compares the bytes.
#
#     scripts/check_reproducible.sh
#
# Compares with target/fmu/CoilWinding.fmu, which scripts/build_fmu.sh --portable has made.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
first=$target/fmu/CoilWinding.fmu

# (a folder for passing files may be small)
copy=$(mktemp -d "$target/elsewhere.XXXXXX")
trap 'rm -rf "$copy"' EXIT
# What is tracked, as it lies here, changes that are not committed included.
git ls-files -z | xargs -0 cp --parents --target-directory="$copy"
mkdir "$copy/target"
# The same linker; it need not be fetched again.
ln -s "$target/venv-build" "$copy/target/venv-build"
(
    cd "$copy"
    unset CARGO_TARGET_DIR
    # The libraries are what may hold paths; the package around them is made by the same program.
    COILWIND_PACK_FMU=$target/release/pack-fmu scripts/build_fmu.sh --portable
)
second=$copy/target/fmu/CoilWinding.fmu
if ! cmp "$first" "$second"; then
    for fmu in "$first" "$second"; do
        echo "$fmu"
        unzip -v "$fmu" 2>/dev/null || true
    done >&2
    echo "check_reproducible.sh: the same sources gave other bytes" >&2
    exit 1
fi
echo "the same bytes: $(sha256sum <"$first" | cut -d' ' -f1)"
