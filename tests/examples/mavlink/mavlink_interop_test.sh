#!/usr/bin/env bash
# Our MAVLink against node-mavlink, which npm fetches into the work directory.
#   mavlink_interop_test.sh MAVLINK_PEER WORK_DIRECTORY
# Exit status 77 (skipped) where there is no node, or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
peer=$1
work=$2
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
    echo "skipped: neither node nor npm is installed"
    exit 77
fi
mkdir -p "$work"
cp "$here/package.json" "$here/package-lock.json" "$work/"
if [ ! -d "$work/node_modules/node-mavlink" ]; then
    (cd "$work" && timeout 200 npm ci --silent --no-audit --no-fund --ignore-scripts) ||
        { echo "skipped: npm could not fetch node-mavlink"; exit 77; }
fi
exec node "$here/mavlink_interop_test.mjs" "$peer" "$work"
