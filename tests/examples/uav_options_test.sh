#!/usr/bin/env bash
# The options of uav about its floor: a wrong value is refused in one line, and a missing floor is reported.
#   uav_options_test.sh UAV
set -uo pipefail
uav=$1
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$root/tests/own_network.sh"
enter_own_network "$@"
work=$(mktemp -d)
pid=
trap 'if [ -n "$pid" ]; then kill -TERM "$pid"; wait "$pid"; fi; rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $1"
    cat "$work/out" "$work/err"
    exit 1
}

# uav ARGUMENTS...: sets `status`.
uav() {
    timeout 60 "$uav" --config "$root/examples/swarm/uav.yaml" --check "$@" >"$work/out" 2>"$work/err"
    status=$?
}

# refused PATTERN ARGUMENTS...
refused() {
    local pattern=$1
    shift
    uav "$@"
    [ "$status" -eq 2 ] || fail "$*: exit code $status"
    grep -q -- "$pattern" "$work/err" || fail "$*: no line '$pattern'"
}
refused 'from -500 to 10000, not nan' --floor nan
refused 'from -500 to 9000, not 9001' --ground-height 9001
refused 'from 0 to 1000, not -1' --clearance -1
refused 'nowhere.yaml' --world nowhere.yaml
uav --floor 460 --ground-height 430 --clearance 20
[ "$status" -eq 0 ] || fail "good options are refused"

# An aircraft without a floor reports that when it starts.
"$uav" --config "$root/examples/swarm/uav.yaml" --domain "$(free_domain)" >"$work/out" 2>"$work/err" &
pid=$!
for ((tries = 0; tries < 600; tries++)); do
    ! grep -q 'there is no floor' "$work/err" || break
    sleep 0.1
done
[ "$tries" -lt 600 ] || fail "nothing is said of a missing floor"
echo passed
