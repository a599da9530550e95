#!/usr/bin/env bash
# Shows rabit foxglove to the package that viewers use. npm fetches it into the work directory.
#   viewer_test.sh RABIT UAV TRANSPORT WORK_DIRECTORY
# Exit status 77 (skipped) where there is no node, or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$4
. "$here/../../../npm_packages.sh"
fetch_npm_packages "$here" @foxglove/ws-protocol "$work"
put_into "$work" "$here/viewer.mjs"
exec python3 "$here/viewer_test.py" "$1" "$2" "$3" "$work/viewer.mjs"
