#!/usr/bin/env bash
# Reads our recordings with the packages that Foxglove uses. npm fetches these into the work directory.
#   stock_reader_test.sh CASE STOCK_SAMPLES WORK_DIRECTORY
# Exit status 77 (skipped) where there is no node, or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case=$1
samples=$2
work=$3
. "$here/../../../npm_packages.sh"
fetch_npm_packages "$here" @mcap/core "$work"
put_into "$work" "$here"/*.mjs
"$samples" "$work"
exec node "$work/stock_reader_test.mjs" "$case" "$work"
