#!/usr/bin/env bash
# Fetches the packages of scripts/report/package-lock.json, unless they are there, and prints their folder.
set -euo pipefail
cd "$(dirname "$0")/../.."
target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)

node=$target/node-report
if ! cmp -s scripts/report/package-lock.json "$node/installed.json"; then
    rm -rf "$node"
    mkdir "$node"
    cp scripts/report/package.json scripts/report/package-lock.json "$node"
    (cd "$node" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2)
    # Last, so that an install that was cut short is made again.
    cp scripts/report/package-lock.json "$node/installed.json"
fi
echo "$node/node_modules"
