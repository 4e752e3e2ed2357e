#!/usr/bin/env bash
# Says what a stage needs that this machine does not have, one line each; nothing if it can run.
#
#     scripts/missing_tools.sh portable | c | sanitizer | valgrind | wine | importers | site | browser
set -euo pipefail

has() { command -v "$1" >/dev/null 2>&1; }
miss() { echo "  $1 is missing; $2"; }

linux_x86() {
    case "$(uname -s)-$(uname -m)" in
        Linux-x86_64) ;;
        *) echo "  $1 runs on x86-64 Linux only, this is $(uname -s) on $(uname -m)" ;;
    esac
}

mingw() {
    has x86_64-w64-mingw32-gcc || miss x86_64-w64-mingw32-gcc "on Debian and Ubuntu: apt install gcc-mingw-w64-x86-64-win32"
}

compiler() {
    linux_x86 "this test"
    has "${CC:-cc}" || miss "a C compiler" "on Debian and Ubuntu: apt install gcc libc6-dev"
}

case ${1-} in
    portable)
        linux_x86 "the portable build"
        for triple in x86_64-unknown-linux-gnu x86_64-pc-windows-gnu; do
            [ -d "$(rustc --print target-libdir --target $triple)" ] ||
                miss "the standard library of Rust for $triple" "with rustup: rustup target add $triple"
        done
        has objdump || miss objdump "on Debian and Ubuntu: apt install binutils"
        mingw
        ;;
    wine)
        mingw
        has wine64 || has wine || miss wine "on Debian and Ubuntu: apt install wine wine64"
        ;;
    c) compiler ;;
    sanitizer)
        compiler
        echo 'int main(void) { return 0; }' |
            "${CC:-cc}" -fsanitize=address,undefined -x c - -o /dev/null 2>/dev/null ||
            miss "the address sanitizer of the C compiler" "on Debian and Ubuntu it comes with apt install gcc"
        ;;
    valgrind)
        compiler
        has valgrind || miss valgrind "on Debian and Ubuntu: apt install valgrind"
        ;;
    importers) linux_x86 "what the importers ship" ;;
    site)
        has node || miss node "on Debian and Ubuntu: apt install nodejs"
        has npm || miss npm "on Debian and Ubuntu: apt install npm"
        ;;
    browser)
        has node || miss node "on Debian and Ubuntu: apt install nodejs"
        has npm || miss npm "on Debian and Ubuntu: apt install npm"
        has chromium || miss chromium "on Debian and Ubuntu: apt install chromium"
        ;;
    *)
        echo "missing_tools.sh: unknown stage ${1-} (see the top of the script)" >&2
        exit 2
        ;;
esac
