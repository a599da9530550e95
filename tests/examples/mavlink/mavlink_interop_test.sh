#!/usr/bin/env bash
# Tests our MAVLink against node-mavlink, which npm fetches into the work directory.
#   mavlink_interop_test.sh MAVLINK_PEER WORK_DIRECTORY
# Exit status 77 (skipped) where there is no node, or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
peer=$1
work=$2
. "$here/../../npm_packages.sh"
fetch_npm_packages "$here" node-mavlink "$work"
exec node "$here/mavlink_interop_test.mjs" "$peer" "$work"
