#!/usr/bin/env bash
# clang for ccache, which remembers only what succeeds and leaves an object: `-c FILE -o OBJECT` reads FILE by its syntax
# alone, and leaves in OBJECT "read" and what clang said. Fails if clang itself does. RABIT_CLANG says which clang.
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
