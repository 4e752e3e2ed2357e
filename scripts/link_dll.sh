#!/usr/bin/env bash
# Links a Windows library with mingw-w64 such that it does not show where sources and tools lie.
#
#     COILWIND_TARGET=.. COILWIND_CRATES=.. COILWIND_TOOLCHAIN=.. scripts/link_dll.sh ARGUMENTS OF THE LINKER
#
# GNU ld orders the imports of a library by the paths of what asks for them, so the same objects elsewhere give
# other bytes. Here it sees the three folders they come from under the same names everywhere.
set -euo pipefail
: "${COILWIND_TARGET:?}" "${COILWIND_CRATES:?}" "${COILWIND_TOOLCHAIN:?}"

names=$(mktemp -d "${TMPDIR:-/tmp}/coilwind-link.XXXXXX")
trap 'rm -rf "$names"' EXIT
ln -s "$COILWIND_TARGET" "$names/target"
ln -s "$COILWIND_CRATES" "$names/crates"
ln -s "$COILWIND_TOOLCHAIN" "$names/toolchain"
cd "$names"

arguments=("$@")
arguments=("${arguments[@]//"$COILWIND_TARGET"/target}")
arguments=("${arguments[@]//"$COILWIND_CRATES"/crates}")
arguments=("${arguments[@]//"$COILWIND_TOOLCHAIN"/toolchain}")
x86_64-w64-mingw32-gcc "${arguments[@]}"
