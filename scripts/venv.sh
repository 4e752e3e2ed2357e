#!/usr/bin/env bash
# Makes a virtual environment, unless it is there, and prints its Python.
#
#     scripts/venv.sh [build | importers | bench | docs | study | render | machine]
#
# Without a word: target/venv with requirements.txt (tests and demonstration). build: target/venv-build
# with requirements-build.txt (the linker of portable libraries). importers: target/venv-importers with
# requirements-importers.txt (other people's FMU importers, which may want other versions of things).
# bench: target/venv-bench with requirements-bench.txt (other simulators, likewise). docs: target/venv-docs
# with requirements-docs.txt (builds the site). study: target/venv-study with requirements-study.txt (calibration, control,
# sweeps through the FMU). render: target/venv-render with requirements-render.txt (pictures and films of a run); machine:
# target/venv-machine with requirements-machine.txt (examples/machine).
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1-} in
    '') suffix= ;;
    build | importers | bench | docs | study | render | machine) suffix=-$1 ;;
    *)
        echo "venv.sh: unknown environment $1 (there are build, importers, bench, docs, study, render and machine, or none)" >&2
        exit 2
        ;;
esac
requirements=requirements$suffix.txt
venv=${CARGO_TARGET_DIR:-target}/venv$suffix
stamp=$venv/requirements.txt
# Windows has Scripts, everybody else bin.
python_of() { if [ -x "$venv/Scripts/python.exe" ]; then echo "$venv/Scripts/python.exe"; else echo "$venv/bin/python"; fi; }

is_there() { cmp -s "$requirements" "$stamp" && "$(python_of)" -c '' 2>/dev/null; }
if is_there; then
    python_of
    exit
fi
# Two that ask for it at once would each remove what the other makes. Where there is no flock, they must not.
if command -v flock >/dev/null; then
    mkdir -p "$(dirname "$venv")"
    exec 9>"$venv.lock"
    flock 9
    if is_there; then
        python_of
        exit
    fi
fi

system=
for candidate in python3 python python3.14 python3.13 python3.12 python3.11 python3.10; do
    if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
        system=$candidate
        break
    fi
done
if [ -z "$system" ]; then
    echo "venv.sh: no Python 3.10 or later found (looked for python3, python, python3.10 to 3.14)" >&2
    exit 1
fi
if ! "$system" -c 'import ensurepip, venv' 2>/dev/null; then
    echo "venv.sh: $system cannot make virtual environments: its venv or ensurepip is missing." >&2
    echo "On Debian and Ubuntu: apt install python3-venv" >&2
    exit 1
fi

echo "making $venv with $("$system" --version)" >&2
rm -rf "$venv"
"$system" -m venv "$venv"
"$(python_of)" -m pip install --quiet --disable-pip-version-check --requirement "$requirements" >&2
# Last, so that an install that was cut short is made anew.
cp "$requirements" "$stamp"
python_of
