#!/usr/bin/env bash
# Runs examples/black_box.sh as a user does, on the loopback of a network of its own, and reads its files with other
# people's programs.
#   black_box_test.sh FOLDER_OF_PROGRAMS TRANSPORT WORK_DIRECTORY_OF_STOCK_READERS WORK_DIRECTORY_OF_BROWSERS
# Without npm, its registry or chromium, the checks that need them are left out, with a message.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)
bin=$1
transport=$2
stock=$3
browser=$4

. "$root/tests/npm_packages.sh"
. "$root/tests/own_network.sh"

# Succeed if the programs that these readers need are available.
stock_reader() {
    (fetch_npm_packages "$root/tests/gateway/recording/stock" @mcap/core "$stock")
}
page() {
    command -v chromium >/dev/null &&
        (fetch_npm_packages "$root/tests/examples/web/browser" playwright-core "$browser")
}
stock_reader >/dev/null
page >/dev/null
enter_own_network "$@"

work=$(mktemp -d)
: >"$work/out"
pid=
trap 'if [ -n "$pid" ]; then kill -TERM "$pid"; wait "$pid"; fi; rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $1"
    cat "$work/out" "$work/err"
    exit 1
}

"$root/examples/black_box.sh" --bin "$bin" --seconds 16 --folder "$work/flight" --transport "$transport" >"$work/out" 2>"$work/err" &
pid=$!
# The limit only keeps a broken test from hanging.
for ((tries = 0; tries < 6000; tries++)); do
    if grep -q '^The replay is at ' "$work/out"; then
        break
    fi
    kill -0 "$pid" 2>/dev/null || fail "it has ended"
    sleep 0.1
done
grep -q '^The replay is at http://127.0.0.1:[0-9]*/?token=[0-9a-f]*$' "$work/out" || fail "no replay within ten minutes"

# Seven nodes were killed hard, and their files are whole again.
[ "$(grep -c '_recovered.mcap: [0-9]* messages$' "$work/out")" -ge 7 ] || fail "seven recordings were to be recovered"
grep -Eq '^flight.mcap: [0-9]+ messages .and [0-9]+ about the time line. by the clock of .*, wrong by [0-9.]+ ms at most$' "$work/out" || fail "nothing was merged"
grep -Eq '^ground +uav1/Pose +[0-9]+ ' "$work/out" || fail "it does not tell what ground knew of uav1"
grep -Eq '^uav1 knew uav2/Pose .*age [0-9.]+ s' "$work/out" || fail "it does not tell how old what uav1 knew of uav2 was"
grep -Eq '^uav1 knew uav3/Pose .*age [1-9][0-9.]* s' "$work/out" || fail "it does not tell how old what uav1 knew of uav3 was"
grep -q 'what ground knew of uav1' "$work/flight/ages.svg" || fail "there is no picture of ages"
for uav in uav1 uav2 uav3; do
    for manager in MissionControl HealthMonitor; do
        grep -Eq "^$uav $manager: [0-9]+ steps, [0-9]+ messages, as recorded$" "$work/out" || fail "$manager of $uav did not do the same again"
    done
done
if "$bin/uav_rerun" --endurance 20 --node uav1 "$work"/flight/rec/uav1_*_recovered.mcap >"$work/changed" 2>&1; then
    fail "another battery was not noticed"
fi
grep -Eq '^uav1 HealthMonitor: step [0-9]+, .* s after its startup: message Health, battery_percent: recorded [0-9.]+, now [0-9.]+$' "$work/changed" ||
    fail "the difference is not named: $(cat "$work/changed")"

if stock_reader; then
    put_into "$stock" "$here/stock_reader.mjs"
    node "$stock/stock_reader.mjs" "$work/flight/flight.mcap" || fail "the stock reader"
fi
if page; then
    put_into "$browser" "$root"/tests/examples/web/browser/*.mjs "$here/replay_page.mjs"
    node "$browser/replay_page.mjs" "$(sed -n 's/^The replay is at //p' "$work/out")" || fail "the page"
fi

kill -INT "$pid"
wait "$pid"
status=$?
pid=
[ "$status" -eq 0 ] || fail "exit code $status"
! grep -q 'command not found' "$work/err" || fail "a program is missing"
