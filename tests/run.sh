#!/usr/bin/env bash
# Installs the Debian packages that are missing, builds the release preset and runs all tests.
# Arguments go to ctest, for instance: tests/run.sh -L core. Without arguments all tests run, except those with the label
# mutation, which test the tests, and those with the labels field_long, fuzz_long, package_long and soak: each set takes
# five minutes or more, soak an hour.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/docker/install-packages.sh"
"$root/docker/install-packages.sh" "$root/docker/packages-check.txt"
"$root/docker/build-preset.sh" release
cd "$root"
[ $# -gt 0 ] || set -- -LE 'mutation|field_long|fuzz_long|package_long|soak'
exec ctest --preset release -j4 --progress "$@"
