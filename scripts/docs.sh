#!/usr/bin/env bash
# Builds the site from docs/ and the pages beside it; dead links, dead anchors and bad formulas fail.
#
#     scripts/docs.sh            to target/site, which opens from the disk: target/site/index.html
#     scripts/docs.sh --serve    on a port of this machine, anew with every change
#
# Needs Python 3.10 or later, Node.js and npm; fetches mkdocs and KaTeX into target/.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)

serve=false
case "$#:${1-}" in
    0:) ;;
    1:--serve) serve=true ;;
    1:-h | 1:--help)
        sed -n '2,/^set /{/^#/!d;s/^# \{0,1\}//;p}' scripts/docs.sh
        exit
        ;;
    *)
        echo "docs.sh: unknown option $* (there is --serve)" >&2
        exit 2
        ;;
esac

missing=$(scripts/missing_tools.sh site)
if [ -n "$missing" ]; then
    printf 'docs.sh: the site cannot be built on this machine:\n%s\n' "$missing" >&2
    exit 1
fi
python=$(scripts/venv.sh docs)

COILWIND_NODE_MODULES=$(scripts/node_modules.sh docs)
export COILWIND_NODE_MODULES
# Says that another generator of sites has come; the versions here are pinned.
export NO_MKDOCS_2_WARNING=1

if $serve; then
    # mkdocs 1.6 watches with newer versions of click only if it is told to.
    exec "$python" -m mkdocs serve --strict --livereload
fi
# Not --quiet: warnings that are not shown do not fail a strict build.
"$python" -m mkdocs build --strict --clean --site-dir "$target/site"
"$python" scripts/docs/check_site.py "$target/site"
