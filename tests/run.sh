#!/usr/bin/env bash
# Installs the Debian packages that are missing, builds the release preset and runs all tests.
# Arguments are handed to ctest, for instance: tests/run.sh -L core
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/docker/install-packages.sh"
"$root/docker/build-preset.sh" release
cd "$root"
exec ctest --preset release -j2 --progress "$@"
