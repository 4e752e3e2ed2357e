#!/usr/bin/env bash
# Winds random valid scenes and writes how they end, into docs/validation/tables/: stability-regions.md (by region of the
# parameter space), stability-worst.md (nearest to each limit), stability-failures.md, stability-refined.md (a sample at
# half the tolerance and half the spacing).
#
#     scripts/stability.sh [COUNT [SEED [SAMPLE]]]     default: 10000 1 200
#
# Takes about four hours on two cores, with progress; 600 scenes and a sample of 60 take a quarter of an hour. What breaks an
# invariant or makes the solver give up is kept, made small, in target/stress/ (or under CARGO_TARGET_DIR). Run again after it was
# stopped, it takes over the part, all scenes or the sample, that the same command had finished. Exits with 1 if an invariant breaks
# or a refined scene ends otherwise, after writing the tables.
set -uo pipefail
cd "$(dirname "$0")/.."

count=${1:-10000}
seed=${2:-1}
sample=${3:-200}
target=${CARGO_TARGET_DIR:-target}
command=${COILWIND_COMMAND:-$target/release/coilwind}
if [ -z "${COILWIND_COMMAND-}" ]; then
    cargo build --locked --release --bin coilwind || exit
fi
out=$target/stress

# part OUT ARGUMENTS...: runs `stress`, with progress on the terminal and lines of scenes in OUT.log, unless OUT.done says that the
# same command did. Returns 1 if an invariant broke.
part() {
    local out=$1 key code
    shift
    key="$(cksum <"$command") $seed $*"
    if [ "$(sed -n 1p "$out.done" 2>/dev/null)" = "$key" ]; then
        return "$(sed -n 2p "$out.done")"
    fi
    rm -f "$out.done"
    "$command" stress "$@" --seed "$seed" --threads 2 --out "$out" >"$out.log"
    code=$?
    if [ "$code" -gt 1 ]; then
        tail -n 1 "$out.log"
        exit "$code"
    fi
    printf '%s\n' "$key" "$code" >"$out.done"
    return "$code"
}

mkdir -p "$target"
part "$out" --count "$count"
status=$?
part "$out-refined" --count "$sample" --no-shrink --refined
if grep -q REFINED "$out-refined.log"; then
    status=1
fi

tables=docs/validation/tables
mkdir -p "$tables"
head_of() {
    printf '<!-- Written by `%s`. Change the script, not this file. -->\n\n# %s\n\n' "scripts/stability.sh $count $seed $sample" "$1"
}
{
    head_of "Stability by region of the parameter space"
    cat <<NOTE
$count random valid scenes, seed $seed. Steps a turn are means, and the largest of one scene. Depth (deepest contact) and energy (unexplained over
what went through) are the worst of the scenes that ended well. Results do not depend on the machine.

NOTE
    cat "$out/stability.md"
} >"$tables/stability-regions.md"
{
    head_of "How near random scenes come to each limit"
    cat <<NOTE
$count random valid scenes, seed $seed. The worst of each measure, with the number of the scene. A scene beyond the mark breaks an
invariant, but for measures that are *reported*. Numerical and remeshing energy are lines of the
[energy balance](../../theory/energy-balance.md) at the end of a run, over plastic work, friction and damping, the work that draws in a
diameter of wire, and the largest motion energy.

NOTE
    cat "$out/worst.md"
} >"$tables/stability-worst.md"
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
{
    head_of "Random scenes at half the tolerance and half the spacing"
    grep -E 'scenes refined' "$out-refined.log" | sed 's/$/./'
    echo
    echo "Defects are the sum that the output \`defect_code\` gives: bulge 1, gap 2, overlap 4, break 8, slack 16."
    if grep -q REFINED "$out-refined.log"; then
        echo
        echo '```text'
        grep REFINED "$out-refined.log" | sed 's/^ *REFINED //; s/; lower the tension.*//; s/; raise tension_setpoint.*//; s/; keep it under.*//'
        echo '```'
    fi
} >"$tables/stability-refined.md"
grep -E '^[0-9]+ cases:' "$out.log"
grep -E 'scenes refined' "$out-refined.log"
exit "$status"
