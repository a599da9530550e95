#!/usr/bin/env bash
# Configures and builds one CMake preset. Usage: build-preset.sh PRESET [TARGET...]
# Shows progress on a terminal; otherwise prints only on failure.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=$1
shift
build=(cmake --build --preset "$preset")
[ $# -eq 0 ] || build+=(--target "$@")

log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cmake --preset "$preset" >"$log" 2>&1; then
    cat "$log" >&2
    echo "build-preset.sh: cmake --preset $preset failed (its output is above)" >&2
    exit 1
fi
if [ -t 2 ]; then
    "${build[@]}" >&2
elif ! "${build[@]}" >"$log" 2>&1; then
    grep -v '^\[[0-9]*/[0-9]*\] ' "$log" >&2 || true
    echo "build-preset.sh: building preset $preset failed (the compiler's output is above)" >&2
    exit 1
fi
