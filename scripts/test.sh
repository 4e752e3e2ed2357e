#!/usr/bin/env bash
# Every check, or the stages that are named.
#
#     scripts/test.sh [--lean] [STAGE...]
#
#     lint    format, lints of every target and set of features, layout of the sources, documentation of the code
#     lab     exact answers, random scenes, benchmarks at their coarsest, results as recorded
#     docs    generated pages, the site, reports in a browser, scripts around runs, what pages tell a reader to type
#     rust    tests of the library, of the command and of the packages beside it
#     fmu     the FMU, the portable FMU, its validation, tests that drive it
#
# --lean deletes what no later stage needs as it goes, 4 GB in all, for machines with little room on their disk.
#
# Without a stage all run, in this order. Needs Rust, a C linker and Python 3.10 or later (the benchmarks 3.11). Parts
# that need more say SKIPPED, with what is missing, where it is not there; scripts/install_tools.sh installs it. Stops at
# the first failure. The summaries of cargo test and pytest come last.
set -euo pipefail
cd "$(dirname "$0")/.."

stages=(lint lab docs rust fmu)
# with nothing built before, on two cores
minutes_of() {
    case $1 in
        lint) echo 6 ;;
        lab) echo 12 ;;
        docs) echo 9 ;;
        rust) echo 11 ;;
        fmu) echo 11 ;;
    esac
}

case ${1-} in
    -h | --help)
        sed -n '2,/^set /{/^#/!d;s/^# \{0,1\}//;p}' scripts/test.sh
        exit
        ;;
esac
lean=false
if [ "${1-}" = --lean ]; then
    lean=true
    shift
fi
for word in "$@"; do
    if [ -z "$(minutes_of "$word")" ]; then
        echo "test.sh: unknown stage $word (there are ${stages[*]})" >&2
        exit 2
    fi
done
chosen=()
for stage in "${stages[@]}"; do
    if [ $# = 0 ] || [[ " $* " = *" $stage "* ]]; then chosen+=("$stage"); fi
done

target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)
command=$target/release/coilwind
fmu=$target/fmu/CoilWinding.fmu
began=$SECONDS
skipped=
skip() {
    printf '\n== SKIPPED %s, because on this machine\n%s\n' "$1" "$2"
    skipped+=$(printf 'SKIPPED %s:\n%s' "$1" "$2")$'\n'
}
# Before the runner whose summary is the last thing that is printed.
say_what_was_skipped() {
    if [ -n "$skipped" ] && [ "${chosen[${#chosen[@]} - 1]}" = "$1" ]; then
        printf '\nNot everything is tested here.\n%s' "$skipped"
    fi
}
step() { printf '\n== %s (at %d s)\n' "$*" $((SECONDS - began)); }

# Runs a function on the second core, for steps that keep one busy. What it prints comes at `join`.
beside=
beside() {
    # In a group of its own, so that all of it can be ended.
    set -m
    "$@" >"$target/beside.log" 2>&1 &
    beside=$!
    set +m
}
join() {
    local code=0
    wait "$beside" || code=$?
    beside=
    cat "$target/beside.log"
    if [ $code != 0 ]; then exit $code; fi
}
trap 'if [ -n "$beside" ]; then kill -- -"$beside" 2>/dev/null || true; fi' EXIT

# What several stages need is built by the first of them.
command_built=false
build_command() {
    if $command_built; then return; fi
    step command
    cargo build --locked --release --bin coilwind
    command_built=true
}
fmu_built=false
build_fmu() {
    if $fmu_built; then return; fi
    step FMU
    scripts/build_fmu.sh
    fmu_built=true
}

# Files in target/ that a stage leaves and no later one needs.
free_after() {
    if ! $lean; then return; fi
    local left=
    case $1 in
        lint) left="doc" ;;
        lab) left="venv-bench labelled stress endurance" ;;
        docs) left="venv-docs venv-render venv-study node-docs node-report site report pages" ;;
        rust) left="debug" ;;
    esac
    local name
    for name in $left; do rm -rf "${target:?}/$name"; done
}

lint() {
    step format
    cargo fmt --all --check

    step lints
    cargo clippy --locked --workspace --all-targets -- -D warnings

    step "lints of the library without its features"
    cargo clippy --locked --package coilwind --lib --no-default-features -- -D warnings
    cargo clippy --locked --package coilwind --lib --no-default-features --features lab -- -D warnings

    step documentation of the code
    RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --no-deps --document-private-items --quiet

    step layout of the sources
    # With what the Rust tests are built with, so that nothing is compiled twice.
    cargo test --locked --workspace --test tidy
}

lab() {
    build_command
    step wide kernels
    scripts/check_lanes.sh "$command"

    step "exact answers; beside them the FMU, most of whose building keeps one core busy"
    beside scripts/build_fmu.sh
    "$command" verify
    "$command" verify --preset paper
    local file
    for file in tests/reference/once_wrong/*.json; do "$command" verify --file "$file"; done

    step random scenes
    "$command" stress --count 200 --seed 1 --quiet --out "$target/stress" | tail -n 1

    step "scenes with a known defect, a sample"
    COILWIND_COMMAND=$command python3 scripts/labelled.py --sample --out "$target/labelled" | tail -n 1

    step "the FMU, to its end"
    join
    fmu_built=true

    step "benchmarks at their coarsest; beside them long runs, short, and results as recorded"
    beside coarse_benchmarks
    COILWIND_COMMAND=$command scripts/endurance.sh --short
    COILWIND_COMMAND=$command scripts/same_results.sh
    join
}
coarse_benchmarks() {
    local log=$target/bench-quick.log
    if ! COILWIND_COMMAND=$command COILWIND_FMU=$fmu scripts/bench.sh --quick >"$log" 2>&1; then
        tail -n 40 "$log"
        exit 1
    fi
    tail -n 1 "$log"
}

docs() {
    build_command
    build_fmu
    local python missing
    python=$(scripts/venv.sh)

    step generated pages
    COILWIND_COMMAND=$command "$python" scripts/reference_pages.py --check

    missing=$(scripts/missing_tools.sh site)
    if [ -z "$missing" ]; then
        step site
        scripts/docs.sh
    else
        skip site "$missing"
    fi

    step "films, calibration, control, sweeps through the FMU, tests of these checks, beside the following"
    # Before both, which use them.
    scripts/venv.sh render >/dev/null
    scripts/venv.sh study >/dev/null
    beside studies "$python"

    missing=$(scripts/missing_tools.sh browser)
    if [ -z "$missing" ]; then
        step "report in a browser"
        COILWIND_COMMAND=$command tests/report/run.sh
    else
        skip "report in a browser" "$missing"
    fi

    step what pages tell a reader to type
    "$python" scripts/docs/check_commands.py

    step "films and the others, to their end"
    say_what_was_skipped docs
    join
}
studies() {
    COILWIND_COMMAND=$command COILWIND_FMU=$fmu COILWIND_RENDER_PYTHON=$(scripts/venv.sh render) \
        "$(scripts/venv.sh study)" -m pytest -q -rs tests/study
    "$1" -m pytest -q -rs tests/docs
}

rust() {
    step Rust tests
    # property tests draw the same cases in every run: a change passes or fails by what it is
    PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED-1} cargo test --locked --workspace
}

fmu() {
    build_command
    build_fmu
    local python missing portable needs importers= machine=
    portable=$(scripts/missing_tools.sh portable)
    if [ -z "$portable" ]; then
        # From here on the FMU is the portable one.
        step portable FMU
        scripts/build_fmu.sh --portable
    else
        skip "portable FMU" "$portable"
    fi

    step validation of the FMU
    python=$(scripts/venv.sh)
    "$python" -m fmpy validate "$fmu"

    step "tests of the FMU, beside the following"
    for needs in c sanitizer valgrind wine importers; do
        missing=$(scripts/missing_tools.sh $needs)
        if [ -n "$missing" ]; then skip "tests that need: $needs" "$missing"; fi
    done
    # Where their packages cannot run they need not be fetched; the tests say so.
    if [ -z "$(scripts/missing_tools.sh importers)" ]; then
        importers=$(scripts/venv.sh importers)
        machine=$(scripts/venv.sh machine)
    fi
    beside fmu_tests "$python" "$importers" "$machine"

    if [ -z "$portable" ]; then
        step portable FMU from another directory
        scripts/check_reproducible.sh
    fi

    step "tests of the FMU, to their end"
    say_what_was_skipped fmu
    join
}
fmu_tests() {
    # -rs names the tests that were skipped, with the reason.
    COILWIND_COMMAND=$command COILWIND_FMU=$fmu COILWIND_IMPORTERS_PYTHON=$2 COILWIND_MACHINE_PYTHON=$3 \
        "$1" -m pytest -q -rs tests/fmpy
}

echo "Stages, with minutes from nothing on two cores (less where target/ holds builds):"
all=0
for stage in "${chosen[@]}"; do
    printf '  %-5s %2d min\n' "$stage" "$(minutes_of "$stage")"
    all=$((all + $(minutes_of "$stage")))
done
printf '  %-5s %2d min\n' sum $all

for stage in "${chosen[@]}"; do
    printf '\n==== %s\n' "$stage"
    $stage
    free_after "$stage"
done
