#!/usr/bin/env bash
# Opens reports in headless Chromium, light and dark: one run with frames and a defect, the same with other numbers and
# in a browser without WebGL, and two side by side, of one wire and of two.
#
#     tests/report/run.sh [--shots DIR | --hundred]
#
# Needs Node.js, npm and Chromium; COILWIND_COMMAND names the command (target/release/coilwind). With --shots pictures of
# the pages are left in DIR. --hundred looks at a coil of 100 turns with 100 frames instead, to see how long it takes to load.
set -euo pipefail
cd "$(dirname "$0")/../.."
target=${CARGO_TARGET_DIR:-target}
command=${COILWIND_COMMAND:-$target/release/coilwind}
out=$target/report
shots=
hundred=false
case "$#:${1-}" in
    0:) ;;
    2:--shots) shots=$2 ;;
    1:--hundred) hundred=true ;;
    *)
        sed -n '2,/^set /{/^#/!d;s/^# \{0,1\}//;p}' tests/report/run.sh
        exit 2
        ;;
esac

scripts/report/bundle.sh --check
modules=$(scripts/node_modules.sh report)
rm -rf "$out"
look() { node tests/report/browser.mjs --modules "$modules" --chromium "$(command -v chromium)" "$@"; }
if $hundred; then
    "$command" run bobbin --set winding.layers=5 --set solver.tolerance=2e-5 --frames 100 --quiet --out "$out/hundred"
    look --page "$out/hundred/report.html" --frames
    exit
fi
"$command" run fig8_gap --set spindle.speed=500 --set spindle.turns=2.6 --set traverse.per_turn_mm=0.95 \
    --frames 6 --quiet --out "$out/gap"
"$command" run fig8 --set spindle.speed=100 --set spindle.turns=1.6 --quiet --out "$out/aligned"
"$command" run fig8 --set wire.material=copper --set wire.diameter_mm=0.5 --set spindle.speed=100 --set spindle.turns=1.6 --quiet --out "$out/thin"
"$command" run tooth --set winding.layers=2 --set winding.turns_per_layer=6 --set core.flange.inner_distance_mm=5.3 --set core.flange.height_mm=2 \
    --set nozzle.y_start_mm=-2.25 --set start.clamp_y_mm=-2.25 --quiet --out "$out/layers"
"$command" report "$out/gap" "$out/aligned"
"$command" report "$out/gap" "$out/thin" --out "$out/unlike.html"
look --page "$out/gap/report.html" --frames ${shots:+--shots "$shots/gap"}
look --page "$out/gap/report.html" --changed ${shots:+--shots "$shots/changed"}
look --page "$out/gap/report.html" --no-webgl ${shots:+--shots "$shots/no-webgl"}
look --page "$out/aligned/report.html" ${shots:+--shots "$shots/aligned"}
look --page "$out/layers/report.html" --layers 2 ${shots:+--shots "$shots/layers"}
look --page "$out/gap/compare.html" --runs 2 ${shots:+--shots "$shots/compare"}
look --page "$out/gap/compare.html" --pair alike ${shots:+--shots "$shots/pair"}
look --page "$out/unlike.html" --pair unlike ${shots:+--shots "$shots/pair"}
