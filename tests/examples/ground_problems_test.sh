#!/usr/bin/env bash
# A ground station whose configuration does not fit the fleet names the problems in its log and on its terminal. Uses a
# real aircraft and a real ground station on loopback.
#   ground_problems_test.sh FOLDER_OF_PROGRAMS TRANSPORT
set -uo pipefail
bin=$1
transport=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$root/tests/own_network.sh"
enter_own_network "$@"
work=$(mktemp -d)
pids=()
trap 'for pid in "${pids[@]}"; do kill -KILL "$pid"; wait "$pid"; done 2>/dev/null; rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $1"
    tail -n +1 "$work"/*.out "$work"/*.err
    exit 1
}

# wait_for FILE TEXT [OPTION]: waits until a line of the file has it; with -E it is a pattern. The limit only keeps a broken
# test from hanging.
wait_for() {
    local tries
    for ((tries = 0; tries < 2400; tries++)); do
        grep -q "${3:--F}" -- "$2" "$1" && return
        sleep 0.1
    done
    fail "no line with '$2' came within four minutes"
}

domain=$(free_domain)

cat >"$work/uav.yaml" <<YAML
node: uav1
interfaces: [127.0.0.1]
publish:
  - {message: Pose, type: Uav::Pose, qos: telemetry}
  - {message: MissionState, type: Uav::MissionState}
accept:
  - {queue: MissionControl, types: [Uav::Goto]}
YAML
cat >"$work/ground.yaml" <<YAML
node: ground
interfaces: [127.0.0.1]
subscribe:
  - {message: Pse, type: Uav::Pose, from: [uav1]}               # misspelt
  - {message: MissionState, type: Uav::Health, from: [uav1]}    # of another type
  - {message: Health, type: Uav::Health, from: [uav9]}          # not there
  - {message: Pose, type: Uav::Pose, from: [uav1]}
accept:
  - {queue: Comands, types: [Uav::CommandAck]}                  # misspelt
YAML

common=(--domain "$domain" --transport "$transport")
"$bin/uav" --config "$work/uav.yaml" "${common[@]}" >"$work/uav.out" 2>"$work/uav.err" &
pids+=($!)
# The station sends a search command that the aircraft's queue does not accept.
ground=("$bin/ground" --config "$work/ground.yaml" "${common[@]}" --expect uav1 --search uav1 --command-period 1)
"${ground[@]}" >"$work/ground.out" 2>"$work/ground.err" &
pids+=($!)

wait_for "$work/ground.err" 'gateway: subscribe Pse, uav1: uav1 does not publish `Pse`; it publishes `Pose`, `MissionState`'
wait_for "$work/ground.err" 'gateway: subscribe MissionState, uav1: uav1 publishes `MissionState` as `Uav::MissionState`, this node wants `Uav::Health`'
wait_for "$work/ground.err" 'gateway: subscribe Health: no node named `uav9` has been heard'
wait_for "$work/ground.err" 'gateway: accept Comands: there is no local queue `Comands`'
wait_for "$work/ground.err" 'gateway: send uav1/MissionControl: '
wait_for "$work/uav.err" 'gateway: send ground/Commands: '
# To its own four at least come those that the aircraft reports of itself.
wait_for "$work/ground.out" ' [5-9] problems: ' -E

# Each problem is logged once, and shown as long as it lasts.
lines=$(wc -l <"$work/ground.out")
for ((tries = 0; tries < 2400 && $(wc -l <"$work/ground.out") < lines + 20; tries++)); do sleep 0.1; done
tail -n 4 "$work/ground.out" | grep -q ' [5-9] problems: ' || fail "the problems are not shown any more"
[ "$(grep -c 'subscribe Pse' "$work/ground.err")" -eq 1 ] || fail "it was said more than once"

# On a terminal the log stands above the table, and the present problems below it.
script -qefc "${ground[*]} --node ground2" /dev/null >"$work/terminal.out" 2>"$work/terminal.err" </dev/null &
pids+=($!)
wait_for "$work/terminal.out" '[5-9] problems:' -E
wait_for "$work/terminal.out" '  subscribe Pse, uav1: uav1 does not publish'
wait_for "$work/terminal.out" 'gateway: subscribe Pse, uav1'
[ "$(grep -c 'gateway: subscribe Pse, uav1' "$work/terminal.out")" -eq 1 ] || fail "the log is not on the terminal once"
echo passed
