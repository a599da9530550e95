#!/usr/bin/env bash
# One test of the web page in a browser.
#   browser_test.sh CASE FOLDER_OF_PROGRAMS WORK_DIRECTORY
# Exit status 77 (skipped) where there is no chromium, no node, or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case=$1
bin=$2
work=$3
for program in chromium node npm; do
    if ! command -v "$program" >/dev/null; then
        echo "skipped: $program is not installed"
        exit 77
    fi
done
mkdir -p "$work"
cp "$here"/*.mjs "$here/package.json" "$here/package-lock.json" "$work/"
if [ ! -d "$work/node_modules/playwright-core" ]; then
    (cd "$work" && timeout 200 npm ci --silent --no-audit --no-fund --ignore-scripts) ||
        { echo "skipped: npm could not fetch playwright-core"; exit 77; }
fi
root=$(cd "$here/../../../.." && pwd)
exec node "$work/run_case.mjs" "$case" "$bin" "$root"
