#!/usr/bin/env bash
# Makes src/output/report/vendor/: what the report of a run holds of other people's code, in one file.
#
#     scripts/report/bundle.sh            writes vendor.min.js, uplot.min.css and LICENSES.txt
#     scripts/report/bundle.sh --check    fails if the files are not those that it would write
#
# The files are checked in, so that building coilwind needs neither Node.js nor npm; this script does.
set -euo pipefail
cd "$(dirname "$0")/../.."
vendor=src/output/report/vendor

case "$#:${1-}" in
    0:) out=$vendor ;;
    1:--check) out=$(mktemp -d) ;;
    *)
        sed -n '2,/^set /{/^#/!d;s/^# \{0,1\}//;p}' scripts/report/bundle.sh
        exit 2
        ;;
esac

modules=$(scripts/node_modules.sh report)
mkdir -p "$out"
# The entry is bundled where its packages are found.
cp scripts/report/vendor.js "$modules/../vendor.js"
node "$modules/esbuild/bin/esbuild" "$modules/../vendor.js" --bundle --minify --target=es2020 --charset=ascii \
    --format=iife --global-name=Vendor --legal-comments=none --log-level=warning --outfile="$out/vendor.min.js"
cp "$modules/uplot/dist/uPlot.min.css" "$out/uplot.min.css"
for package in three uplot; do
    version=$(node -p "require('$modules/$package/package.json').version")
    printf '%s %s\n\n' "$package" "$version"
    cat "$modules/$package/LICENSE"
    printf '\n'
done >"$out/LICENSES.txt"

if [ "$out" != "$vendor" ]; then
    diff -rq "$vendor" "$out"
    rm -r "$out"
fi
