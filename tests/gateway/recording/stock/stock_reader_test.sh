#!/usr/bin/env bash
# Our recordings, read by the packages that Foxglove reads them with, which npm fetches into the work directory.
#   stock_reader_test.sh CASE STOCK_SAMPLES WORK_DIRECTORY
# Exit status 77 (skipped) where there is no node, or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case=$1
samples=$2
work=$3
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
    echo "skipped: neither node nor npm is installed"
    exit 77
fi
mkdir -p "$work"
cp "$here/package.json" "$here/package-lock.json" "$work/"
if [ ! -d "$work/node_modules/@mcap/core" ]; then
    (cd "$work" && timeout 200 npm ci --silent --no-audit --no-fund --ignore-scripts) ||
        { echo "skipped: npm could not fetch @mcap/core"; exit 77; }
fi
cp "$here"/*.mjs "$work/"
"$samples" "$work"
exec node "$work/stock_reader_test.mjs" "$case" "$work"
