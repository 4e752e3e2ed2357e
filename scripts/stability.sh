#!/usr/bin/env bash
# Winds random valid scenes and writes how they end: docs/validation/tables/stability-regions.md, by region of the parameter
# space, and stability-failures.md.
#
#     scripts/stability.sh [COUNT [SEED]]     default: 2000 1
#
# What breaks an invariant or makes the solver give up is kept, made small, in target/stress/ (or under
# CARGO_TARGET_DIR). Exits with 1 if an invariant breaks, after writing the tables.
set -uo pipefail
cd "$(dirname "$0")/.."

count=${1:-2000}
seed=${2:-1}
target=${CARGO_TARGET_DIR:-target}
cargo build --locked --release --bin coilwind || exit
out=$target/stress
"$target/release/coilwind" stress --count "$count" --seed "$seed" --out "$out" >"$out.log"
status=$?
if [ "$status" -gt 1 ]; then
    tail -n 1 "$out.log"
    exit "$status"
fi
tables=docs/validation/tables
mkdir -p "$tables"
head_of() {
    printf '<!-- Written by `%s`. Change the script, not this file. -->\n\n# %s\n\n' "scripts/stability.sh $count $seed" "$1"
}
{
    head_of "Stability by region of the parameter space"
    cat <<NOTE
$count random valid scenes, seed $seed. Steps a turn are means, and the largest of one scene. Depth (deepest contact) and energy (unexplained over
what went through) are the worst of the scenes that ended well. Results do not depend on the machine.

NOTE
    sed -n '/^| | cases/,$p' "$out.log" | sed '$d' | sed -e :a -e '/^\n*$/{$d;N;ba' -e '}'
} >"$tables/stability-regions.md"
{
    head_of "Random scenes that gave up or broke an invariant"
    echo "$count random valid scenes, seed $seed. A line each: number, signal, core, wire, tension, top speed, and how the run ended."
    echo
    if grep -qE 'gave up at|INVARIANT' "$out.log"; then
        echo '```text'
        grep -E '^ *[0-9]+ .*(gave up at|INVARIANT)' "$out.log" | sed 's/; raise tension_setpoint.*//'
        echo '```'
    else
        echo "None."
    fi
} >"$tables/stability-failures.md"
tail -n 1 "$out.log"
exit "$status"
