#!/usr/bin/env bash
# Winds random valid scenes and writes docs/stability.md: how they end, by region of the parameter space.
#
#     scripts/stability.sh [COUNT [SEED]]     default: 2000 1
#
# What breaks an invariant or makes the solver give up is kept, made small, in target/stress/ (or under
# CARGO_TARGET_DIR). Exits with 1 if an invariant breaks, after writing the page.
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
{
    cat <<PAGE
# Stability by region of the parameter space

\`scripts/stability.sh $count $seed\` wrote this page: $count random valid scenes (seed $seed) of 0.25 to 2 turns, each with random
input signals, wound by the production method and judged at every communication point. A run that is refused by no
rule of the scene has to end as *completed*, *wire broke* (tension above its strength or folded to a kink, as a machine can do it) or *gave
up* (the solver says when, where and why). *invariant* counts scenes that broke one of these: no panic, finite
state, energy balance, wire outside the core, friction inside its cone, wire length equals fed length, no plastic work
that comes back, no pushing at the nozzle, frozen wire unmoved, a bound on steps per turn.

Wire *runs away from the nozzle* where an elastic coil opens or a loop whirls round under little tension: the line behind the nozzle has
no inertia in this model, so wire once fast shoots on, at 20 to 300 m/s (ARCHITECTURE, "Known and left").

Steps per turn are means and the largest of one scene; depth (deepest contact) and energy (unexplained over what went
through) are the worst of the scenes that ended well.

PAGE
    sed -n '/^| | cases/,$p' "$out.log" | sed '$d'
    echo
    echo "## Every scene that gave up or broke an invariant"
    echo
    if grep -qE 'gave up at|INVARIANT' "$out.log"; then
        echo '```'
        grep -E '^ *[0-9]+ .*(gave up at|INVARIANT)' "$out.log" | cut -c1-400
        echo '```'
    else
        echo "None."
    fi
} >docs/stability.md
tail -n 1 "$out.log"
exit "$status"
