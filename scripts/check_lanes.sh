#!/usr/bin/env bash
# Checks that the wide kernels of a program are compiled whole.
#
#     scripts/check_lanes.sh PROGRAM
#
# A vector instruction that is a function of its own is called for every product: what stands between it and its kernel, such as
# a closure that is used twice, was not inlined. Then the kernel takes a third longer, with the same results.
set -euo pipefail
program=${1:?usage: check_lanes.sh PROGRAM}
symbols=$(nm -C "$program")
grep -q 'coilwind::' <<<"$symbols" || {
    echo "check_lanes.sh: $program has no symbols to look at" >&2
    exit 1
}
if calls=$(grep -oE 'core_arch::x86::(avx|avx2|fma|avx512f|sse2)::\w+' <<<"$symbols"); then
    echo "check_lanes.sh: $program calls these instead of using them:" $calls >&2
    exit 1
fi
