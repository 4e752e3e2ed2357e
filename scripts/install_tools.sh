#!/usr/bin/env bash
# Installs what scripts/test.sh would skip a stage for, as far as this machine and user allow.
#
#     scripts/install_tools.sh
#
# Rust targets through rustup; compilers, wine, valgrind, Node.js and Chromium through apt-get, as root. What cannot be
# installed is named, and is no failure: scripts/test.sh says then which stages it skips, and why.
set -euo pipefail
cd "$(dirname "$0")/.."

cannot() { echo "install_tools.sh: $*" >&2; }

triple=x86_64-pc-windows-gnu
if [ ! -d "$(rustc --print target-libdir --target $triple)" ]; then
    if command -v rustup >/dev/null; then
        rustup target add $triple || cannot "rustup could not add the target $triple"
    else
        cannot "no rustup to add the target $triple with"
    fi
fi

packages=()
wants() { if [ -n "$(scripts/missing_tools.sh "$1" | grep "$2" || true)" ]; then packages+=("$3"); fi; }
wants portable mingw gcc-mingw-w64-x86-64-win32
wants portable objdump binutils
wants valgrind "valgrind is missing" valgrind
wants wine "wine is missing" wine
wants wine "wine is missing" wine64
wants c "compiler is missing" gcc
wants site "node is missing" nodejs
wants site "npm is missing" npm
wants browser "chromium is missing" chromium
[ ${#packages[@]} -gt 0 ] || exit 0

if ! command -v apt-get >/dev/null; then
    cannot "no apt-get to install ${packages[*]} with"
elif [ "$(id -u)" != 0 ]; then
    cannot "only root can install ${packages[*]}; ask for it: apt-get install ${packages[*]}"
else
    export DEBIAN_FRONTEND=noninteractive
    # One by one: a package that is not to be had keeps no other away.
    apt-get update -qq || cannot "apt-get update failed"
    for package in "${packages[@]}"; do
        apt-get install -y -qq --no-install-recommends "$package" >/dev/null ||
            cannot "apt-get could not install $package"
    done
fi
