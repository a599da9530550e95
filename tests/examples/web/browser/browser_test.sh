#!/usr/bin/env bash
# One test of the web page in a browser.
#   browser_test.sh CASE FOLDER_OF_PROGRAMS WORK_DIRECTORY
# Exit status 77 (skipped) where there is no chromium, no node, or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case=$1
bin=$2
work=$3
root=$(cd "$here/../../../.." && pwd)
. "$root/tests/npm_packages.sh"
command -v chromium >/dev/null || skip "there is no browser" chromium
fetch_npm_packages "$here" playwright-core "$work"
. "$root/tests/own_network.sh"
enter_own_network "$@"
put_into "$work" "$here"/*.mjs
exec node "$work/run_case.mjs" "$case" "$bin" "$root"
