#!/usr/bin/env bash
# Checks what a library of the FMU shows to the world, from its symbol tables.
#
#     scripts/check_library.sh [--glibc VERSION] LIBRARY
#
# It must export every function of FMI 2.0 for co-simulation and nothing else. With --glibc no
# symbol may need a glibc newer than that. No path of the machine that built it may be inside.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)

ceiling=
if [ "${1-}" = --glibc ]; then
    ceiling=$2
    shift 2
fi
library=${1:?usage: check_library.sh [--glibc VERSION] LIBRARY}
fail() {
    echo "check_library.sh: $library $*" >&2
    exit 1
}

case $library in
    *.dll)
        exports=$(x86_64-w64-mingw32-objdump -p "$library" |
            awk '/^\[Ordinal\/Name Pointer\] Table/ { on = 1; next } NF == 0 { on = 0 } on { print $NF }')
        ;;
    *) exports=$(nm -D --defined-only "$library" | awk '{ print $3 }') ;;
esac
# The header of the C tests declares what the standard wants.
wanted=$(sed -nE 's/^ *X\([A-Za-z0-9]+, (fmi2[A-Za-z]+),.*/\1/p' "$here/tests/c/fmi2.h" | LC_ALL=C sort -u)
difference=$(diff <(echo "$wanted") <(echo "$exports" | LC_ALL=C sort -u)) ||
    fail "does not export what it should (<: missing, >: too much):"$'\n'"$difference"

if [ -n "$ceiling" ]; then
    needed=$(objdump -T "$library" | grep -oE 'GLIBC_[0-9.]+' | sed 's/GLIBC_//' | sort -uV | tail -1)
    [ -n "$needed" ] || fail "names no glibc version"
    [ "$(printf '%s\n' "$needed" "$ceiling" | sort -V | tail -1)" = "$ceiling" ] ||
        fail "needs glibc $needed, not $ceiling"
    echo "needs glibc $needed"
fi

for path in "$here" "${CARGO_HOME:-$HOME/.cargo}" "$HOME/"; do
    if [ -n "$ceiling" ] || [ "${library##*.}" = dll ]; then
        if LC_ALL=C grep -aqF "$path" "$library"; then fail "contains the path $path"; fi
    fi
done
echo "$library: $(echo "$exports" | wc -l) functions, $(wc -c <"$library") bytes"
