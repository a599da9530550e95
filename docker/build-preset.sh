#!/usr/bin/env bash
# Configures and builds one CMake preset. Usage: build-preset.sh PRESET [TARGET...]
# Shows progress on a terminal; otherwise prints a line each minute that it takes, and the compiler's output on failure.
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
    exit
fi
"${build[@]}" >"$log" 2>&1 &
builder=$!
trap 'kill "$builder" 2>/dev/null || true; rm -f "$log"' EXIT
trap 'exit 130' INT TERM
for ((tick = 1; ; ++tick)); do
    kill -0 "$builder" 2>/dev/null || break
    sleep 0.2
    if ((tick % 300 == 0)); then
        steps=$(grep -o '^\[[0-9]*/[0-9]*\]' "$log" | tail -n 1) || true
        echo "building preset $preset for $((tick / 300)) min: steps ${steps:-not known}" >&2
    fi
done
if ! wait "$builder"; then
    grep -v '^\[[0-9]*/[0-9]*\] ' "$log" >&2 || true
    echo "build-preset.sh: building preset $preset failed (the compiler's output is above)" >&2
    exit 1
fi
