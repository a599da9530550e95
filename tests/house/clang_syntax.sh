#!/usr/bin/env bash
# Runs clang for ccache, which remembers only successes that leave an object. `-c FILE -o OBJECT` checks the syntax of
# FILE and leaves in OBJECT "read" and clang's messages. Fails if clang itself does. RABIT_CLANG says which clang.
set -uo pipefail
words=()
object=
while [ $# -gt 0 ]; do
    if [ "$1" = -o ]; then
        object=$2
        shift 2
    else
        words+=("$1")
        shift
    fi
done
[ -n "$object" ] || exec "$RABIT_CLANG" "${words[@]}"
said=$("$RABIT_CLANG" -fsyntax-only "${words[@]}" -fno-color-diagnostics 2>&1)
status=$?
if [ "$status" -gt 1 ]; then
    printf '%s\n' "$said" >&2
    exit "$status"
fi
[ "$status" -eq 0 ] && said=
printf 'read\n%s' "$said" >"$object"
