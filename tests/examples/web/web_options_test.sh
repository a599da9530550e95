#!/usr/bin/env bash
# The option --web of ground, when it cannot be had: one line, exit code 2, nothing started.
#   web_options_test.sh GROUND WEB_FIXTURE
set -uo pipefail
ground=$1
fixture=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
work=$(mktemp -d)
mkfifo "$work/in"
"$fixture" 1 <"$work/in" >"$work/fixture" 2>&1 &
fixture_pid=$!
exec 3>"$work/in"
trap 'exec 3>&-; kill "$fixture_pid" 2>/dev/null; wait "$fixture_pid" 2>/dev/null; rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $1"
    cat "$work/out" "$work/err"
    exit 1
}

# refused ARGUMENT ERROR: also with --check.
refused() {
    local extra
    for extra in '' --check; do
        # shellcheck disable=SC2086 # none or one word
        timeout 60 "$ground" --config "$root/examples/ground_station/ground.yaml" --web "$1" $extra \
            >"$work/out" 2>"$work/err"
        [ $? -eq 2 ] || fail "--web $1 $extra: another exit code than 2"
        [ "$(wc -l <"$work/err")" -eq 1 ] || fail "--web $1 $extra: more than one line"
        grep -qF -- "$2" "$work/err" || fail "--web $1 $extra: not the line '$2'"
        [ ! -s "$work/out" ] || fail "--web $1 $extra: something was started"
    done
}

refused 127.0.0.1:x "--web 127.0.0.1:x: expected a port from 0 to 65535, found 'x'"
refused field:80 'expected PORT, ADDRESS:PORT or [ADDRESS]:PORT with a numerical address'
refused 192.0.2.1:0 'cannot be served at http://192.0.2.1:0/: Cannot assign requested address'
for ((i = 0; i < 600; i++)); do
    url=$(grep -o 'http://[^ ]*' "$work/fixture") && break
    sleep 0.1
done
port=$(grep -o '[0-9]*/$' <<<"$url" | tr -d /)
refused "$port" "cannot be served at $url: Address already in use"
echo passed
