#!/usr/bin/env bash
# Runs examples/demo.sh as a user does, on the loopback of a network of its own. Usage: demo_test.sh CASE FOLDER_OF_PROGRAMS
set -uo pipefail
case=$1
bin=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$root/tests/own_network.sh"
enter_own_network "$@"
work=$(mktemp -d)
demo_pid=
trap 'if [ -n "$demo_pid" ]; then kill -TERM "$demo_pid"; wait "$demo_pid"; fi; rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $1"
    echo "--- standard output"
    cat "$work/out"
    echo "--- standard error"
    cat "$work/err"
    exit 1
}

# demo ARGUMENTS: runs to its end, sets `status`.
demo() {
    "$root/examples/demo.sh" --bin "$bin" "$@" >"$work/out" 2>"$work/err"
    status=$?
}

start_demo() {
    "$root/examples/demo.sh" --bin "$bin" "$@" >"$work/out" 2>"$work/err" &
    demo_pid=$!
}

# wait_for FILE PATTERN: waits until a line of the file matches. The limit only keeps a broken test from hanging.
wait_for() {
    local tries
    for ((tries = 0; tries < 3000; tries++)); do
        grep -q -- "$2" "$1" && return
        sleep 0.1
    done
    fail "no line '$2' came within five minutes"
}

end_demo() {
    wait "$demo_pid"
    status=$?
    demo_pid=
}

# Prints the process ids that the demo reported.
started() {
    grep -o '([0-9]*)' "$work/err" | tr -d '()'
}

expect_status() {
    [ "$status" -eq "$1" ] || fail "exit code $status instead of $1"
}

# The flight passed, but for the share of poses that were heard: a ground station that is slow reads the newest pose and
# skips those before it. The share is computed from the numbers of poses, and PoseCountTest and VerdictTest judge that.
expect_passed() {
    local failures
    failures=$(grep '^  FAILED: ' "$work/out")
    if [ -z "$failures" ]; then
        expect_status 0
        grep -qx Passed "$work/out" || fail "no summary"
        return
    fi
    ! grep -vE ': only [0-9.]+ % of its poses were heard, not 90\.0 %$' <<<"$failures" || fail "the flight failed"
    expect_status 1
    grep -qx Failed "$work/out" || fail "no summary"
}

expect_no_processes_left() {
    local pid
    [ -n "$(started)" ] || fail "no process ids were printed"
    for pid in $(started); do
        ! kill -0 "$pid" 2>/dev/null || fail "process $pid is left over"
    done
}

case $case in
ends_by_itself)
    demo --uavs 1 --seconds 20 --web off
    expect_passed
    grep -q 'uav1   UP      pose (age' "$work/out" || fail "uav1 was not shown as UP"
    expect_no_processes_left
    ;;
finds_a_target_on_both_backends)
    start_demo --transport mixed
    wait_for "$work/err" '^Web page: http://127.0.0.1:[0-9]*/?token=[0-9a-f]*$'
    wait_for "$work/out" 'target uav[1-3]/[0-9]* *TRACKED .* validated by uav[1-3], followed'
    kill -INT "$demo_pid"
    end_demo
    expect_passed
    for node in uav1 uav2 uav3; do
        grep -q "$node   UP      pose (age" "$work/out" || fail "$node was not shown as UP"
    done
    expect_no_processes_left
    ;;
finds_a_target_with_keys_on_both_backends)
    start_demo --transport mixed --secure --web off
    wait_for "$work/out" 'target uav[1-3]/[0-9]* *TRACKED .* validated by uav[1-3], followed'
    look=$(sed -n 's/^Strangers are kept out. To look at it: //p' "$work/err")
    laptop=$(sed 's/.* --keys \([^ ]*\) .*/\1/' <<<"$look")
    [ "$(stat -c %a "$(dirname "$(dirname "$laptop")")")" = 700 ] || fail "others may look at the keys"
    # The exit code is 1 if a node has a problem.
    # shellcheck disable=SC2086 # the command is words
    $look --wait 10 >"$work/nodes" 2>&1 || [ $? -eq 1 ] || fail "a program with keys does not see it: $(cat "$work/nodes")"
    "$bin/rabit" nodes --domain "$(sed -n 's/^DDS domain \([0-9]*\).*/\1/p' "$work/err")" --interface lo >"$work/nodes" 2>&1
    grep -q 'nobody was heard in domain' "$work/nodes" || fail "a program without keys hears it: $(cat "$work/nodes")"
    kill -INT "$demo_pid"
    end_demo
    expect_passed
    [ ! -e "$laptop" ] || fail "keys are left over"
    expect_no_processes_left
    ;;
fails_without_a_target)
    demo --uavs 2 --seconds 12 --web off
    expect_status 1
    grep -q 'FAILED: no target was found by one aircraft, validated by another, and followed' "$work/out" ||
        fail "the summary does not say what is missing"
    expect_no_processes_left
    ;;
shows_a_killed_aircraft)
    start_demo --web off
    wait_for "$work/out" 'uav2   UP '
    kill -KILL "$(grep -o 'uav2 ([0-9]*)' "$work/err" | grep -o '[0-9]*)' | tr -d ')')"
    wait_for "$work/out" 'uav2   STALE   OLD pose'
    wait_for "$work/out" 'uav2   LOST    OLD pose'
    kill -INT "$demo_pid"
    end_demo
    expect_status 1
    grep -q 'FAILED: uav2 was LOST at the end' "$work/out" || fail "the summary does not tell of uav2"
    grep -q 'uav2 ended before its time with exit code 137' "$work/err" || fail "the end of uav2 is not told"
    expect_no_processes_left
    ;;
ends_in_order_when_interrupted)
    start_demo --uavs 1 --web off
    wait_for "$work/out" 'uav1 .* commands 1 sent 1 acknowledged'
    # A mission state a second opens the count of poses and another one ends it.
    wait_for "$work/out" '^ *\([89]\|[1-9][0-9][0-9]*\)\.[0-9] s .*uav1'
    kill -INT "$demo_pid"
    end_demo
    expect_passed
    expect_no_processes_left
    ;;
flies_a_track)
    {
        echo time_s,latitude_deg,longitude_deg,altitude_m,velocity_north_mps,velocity_east_mps,velocity_down_mps,roll_rad,pitch_rad,yaw_rad
        echo 0,12.5,34.5,111,0,0,0,0,0,0
    } >"$work/track.csv"
    start_demo --uavs 1 --web off --track "$work/track.csv"
    wait_for "$work/out" 'uav1   UP .* 12.5[0-9]* 34.5[0-9]* '
    kill -TERM "$demo_pid"
    end_demo
    expect_no_processes_left
    ;;
warns_where_processors_are_busy)
    taskset -c 0 timeout 400 sh -c 'while :; do :; done' &
    busy=$!
    taskset -c 0 "$root/examples/demo.sh" --bin "$bin" --uavs 20 --seconds 1 --web off >"$work/out" 2>"$work/err"
    kill "$busy"
    grep -q '^demo.sh: 20 aircraft need about 0.80 of a processor, and 0.[0-9]* is idle' "$work/err" ||
        fail "no warning"
    ;;
refuses_a_bad_track)
    echo time_s,latitude_deg,oops >"$work/track.csv"
    demo --seconds 5 --track "$work/track.csv"
    expect_status 2
    [ "$(cat "$work/err")" = "$work/track.csv:1:21: expected the column name longitude_deg, found 'oops'" ] ||
        fail "another error was expected"
    [ ! -s "$work/out" ] || fail "something was started"
    ;;
refuses_a_track_that_is_missing_before_it_builds)
    # Without --bin it would install and build first.
    "$root/examples/demo.sh" --uavs 1 --track "$work/none.csv" >"$work/out" 2>"$work/err"
    status=$?
    expect_status 2
    grep -q "^demo.sh: --track: there is no file '$work/none.csv' that can be read" "$work/err" || fail "another error was expected"
    [ ! -s "$work/out" ] || fail "something was done first"
    ;;
refuses_a_domain_in_use)
    start_demo --uavs 1 --web off --domain 7
    wait_for "$work/out" 'uav1   UP '
    "$root/examples/demo.sh" --bin "$bin" --uavs 1 --web off --domain 7 >"$work/out2" 2>"$work/err2"
    status=$?
    expect_status 2
    grep -q '^demo.sh: a program of this machine is in DDS domain 7 already' "$work/err2" || fail "another error was expected: $(cat "$work/err2")"
    kill -INT "$demo_pid"
    end_demo
    expect_no_processes_left
    ;;
outlives_the_cut_of_the_mesh | outlives_the_cut_of_the_mesh_with_keys)
    ip netns list >/dev/null 2>&1 || skip "needs network namespaces" iproute2
    with=()
    [ "$case" = outlives_the_cut_of_the_mesh ] || with=(--secure --transport cyclonedds)
    start_demo --radios two --uavs 1 --seconds 30 --web off "${with[@]}"
    for ((tries = 0; tries < 600; tries++)); do
        ! grep -q 'no such networks can be made\|needs root' "$work/err" || skip "no network namespace can be made"
        ! grep -q 'uav1   UP ' "$work/out" || break
        sleep 0.1
    done
    mesh=$(grep -o 'mesh is rbmesh[0-9]*' "$work/err" | grep -o 'rbmesh[0-9]*$')
    ip link set "$mesh" down
    end_demo
    expect_passed
    expect_no_processes_left
    ! ip netns list | grep -q "rabit_${mesh}_" || fail "a namespace is left"
    ;;
refuses_bad_options)
    for arguments in '--uavs 0' '--uavs 21' '--uavs x' '--seconds 0' '--domain 233' '--transport carrier' '--web 0' '--radios three' --oops; do
        # shellcheck disable=SC2086 # two words
        demo $arguments
        expect_status 2
        [ "$(wc -l <"$work/err")" -eq 1 ] || fail "one line was expected for $arguments"
    done
    ;;
*)
    echo "demo_test.sh: no case '$case'" >&2
    exit 1
    ;;
esac
