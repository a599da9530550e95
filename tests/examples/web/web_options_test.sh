#!/usr/bin/env bash
# The option --web of ground with an unusable argument: one line is printed, the exit code is 2, nothing is started.
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

# Other users of this machine reach its loopback address, so the page needs a token there, too.
serve() { # serve OPTION...: it ends without having heard an aircraft
    timeout 60 "$ground" --config "$root/examples/ground_station/ground.yaml" --seconds 1 "$@" >"$work/out" 2>"$work/err"
    [ $? -eq 1 ] || fail "$*: it does not run"
}
serve --web 0
grep -q '^Web page: http://127.0.0.1:[0-9]*/?token=[0-9a-f]\{32\}$' "$work/err" || fail "no address with a token on loopback"
serve --web 0 --web-open-to-everybody-on-the-network
grep -q '^Web page: http://127.0.0.1:[0-9]*/$' "$work/err" || fail "an open page has a token"
grep -q '^Anybody who reaches this port commands the fleet' "$work/err" || fail "it does not say that the page is open"

# Beyond this machine the page needs TLS and a token, the same at each start where they are kept.
addresses() { grep -o 'https://[^ ]*' "$work/err" | sed 's/:[0-9][0-9]*\//\//'; }
serve --web 0.0.0.0:0
first=$(addresses)
grep -q '/?token=[0-9a-f]\{32\}$' <<<"$first" || fail "no address with a token"
grep -q '^Its certificate, SHA-256: ' "$work/err" || fail "it does not say how its certificate is known"
serve --web 0.0.0.0:0
[ "$(addresses)" != "$first" ] || fail "a second start has the token of the first"
serve --web 0.0.0.0:0 --web-keys "$work/keys"
first=$(addresses)
serve --web 0.0.0.0:0 --web-keys "$work/keys"
[ "$(addresses)" = "$first" ] || fail "a second start has not the token that is kept"
chmod 640 "$work/keys/token"
for extra in --check --seconds=1; do
    timeout 60 "$ground" --config "$root/examples/ground_station/ground.yaml" --web 0.0.0.0:0 --web-keys "$work/keys" \
        $extra >"$work/out" 2>"$work/err"
    [ $? -eq 2 ] || fail "a token that others may read is taken"
    grep -q '/token is not for its owner alone (mode 640)' "$work/err" || fail "it does not say what is wrong with the token"
done
timeout 60 "$ground" --web 0.0.0.0:0 --web-keys "$work/keys" --web-open-to-everybody-on-the-network 2>"$work/err"
[ $? -eq 2 ] || fail "a page with keys is open to everybody"
timeout 60 "$ground" --help | tr -s ' \n' ' ' | grep -q 'anybody who reaches the port commands the fleet' ||
    fail "the help does not say what an open page means"
echo passed
