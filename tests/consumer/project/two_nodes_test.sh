#!/usr/bin/env bash
# two_nodes_test.sh STATION DISPLAY: the display shows the station's measurements, and its order changes them. Both
# end with exit code 0 when they are told to.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
"$1" --config station.yaml &
station=$!
coproc shown { exec "$2" --config display.yaml; }
display=$shown_PID
trap 'kill -KILL "$station" "$display" 2>/dev/null || true' EXIT

# The limit only keeps a broken test from hanging.
wait_for() {
    local line
    while read -r -t 120 line <&"${shown[0]}"; do
        [ "$line" != "$1" ] || return 0
    done
    echo "the display has not shown: $1" >&2
    return 1
}
wait_for "5 m/s from 270 degrees"
wait_for "10 m/s from 270 degrees"
kill -TERM "$station" "$display"
wait "$station"
wait "$display"
trap - EXIT
echo "ok: both nodes"
