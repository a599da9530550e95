#!/usr/bin/env bash
# Flies the demo with recorders on board, ends it like a loss of power, and examines the recordings. See
# usage() below and docs/how_to/after_a_flight.md.
set +m -uo pipefail # no job control: processes started with & keep the process id that $! names

usage() {
    cat <<'USAGE'
Usage: black_box.sh [OPTION]...
Flies three simulated aircraft that search for targets, and a ground station, as demo.sh does. Each process records itself.
After three quarters of the flight uav3 is killed, and at its end all others at once. What they left is recovered, merged onto one time line, looked at, run again, and
played into the page of a ground station until Ctrl-C. Prints each command that it runs.

  --seconds N        fly for N seconds from when all aircraft are heard, 1 to 86400 (default 60)
  --folder DIR       where all of it goes (default: black_box_ and the time, here); must not be there yet
  --transport NAME   as demo.sh has it
  --web PORT         port of the page, 1 to 65535 (default: any that is free), or `off`: nothing is played
  --bin DIR          take the programs uav, uav_rerun, vision, ground and rabit from this folder; build nothing
  -h, --help         show this and exit

Exit code: 0 if all of it worked, and what decides in the aircraft did the same when it was run again; 1 if not; 2 if an
option is wrong.
USAGE
}

fail_usage() {
    echo "black_box.sh: $1 (--help shows the options)" >&2
    exit 2
}

fail() {
    echo "black_box.sh: $1" >&2
    exit 1
}

# A script that starts this one with & hands it an ignored SIGINT, which bash cannot trap: start again with it restored.
ignored=$(sed -n 's/^SigIgn:[[:space:]]*//p' /proc/$$/status)
if ((0x${ignored:-0} & 2)); then
    exec env --default-signal=INT "$BASH" "${BASH_SOURCE[0]}" "$@"
fi

seconds=60
folder=black_box_$(date -u +%Y%m%dT%H%M%SZ)
transport=fastdds
web=0
bin=
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help)
        usage
        exit 0
        ;;
    --*=*) # --option=value
        set -- "${1%%=*}" "${1#*=}" "${@:2}"
        continue
        ;;
    --seconds | --folder | --transport | --web | --bin)
        [ $# -ge 2 ] || fail_usage "$1 needs a value"
        ;;
    *) fail_usage "unknown option '$1'" ;;
    esac
    case $1 in
    --seconds)
        if ! [[ $2 =~ ^[1-9][0-9]{0,4}$ ]] || [ "$2" -gt 86400 ]; then
            fail_usage "--seconds must be a number from 1 to 86400, not '$2'"
        fi
        seconds=$2
        ;;
    --folder) folder=$2 ;;
    --transport) transport=$2 ;;
    --web) web=$2 ;;
    --bin) bin=$2 ;;
    esac
    shift 2
done
[ ! -e "$folder" ] || fail_usage "there is something at '$folder' already"

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$here")
if [ -z "$bin" ]; then
    "$root/docker/install-packages.sh" || exit 1
    "$root/docker/build-preset.sh" release uav uav_rerun vision ground rabit || exit 1
    bin=$root/build/release/bin
fi
bin=$(cd "$bin" && pwd) || fail_usage "there is no folder of programs"
for program in uav uav_rerun vision ground rabit; do
    [ -x "$bin/$program" ] || fail_usage "there is no program $bin/$program"
done
mkdir -p -- "$folder" || exit 2
cd -- "$folder" || exit 2

demo_pid=
pids=() # of the ground station and the player
on_exit() {
    trap - EXIT
    trap '' INT TERM HUP
    local pid
    [ -z "$demo_pid" ] || kill -TERM "$demo_pid" 2>/dev/null
    for pid in "${pids[@]}"; do
        kill -TERM "$pid" 2>/dev/null
    done
    wait
}
trap on_exit EXIT
trap 'exit 130' INT TERM HUP

# wait_for FILE PATTERN PID: waits until a line of the file matches, or the process has ended.
wait_for() {
    until grep -q -- "$2" "$1"; do
        kill -0 "$3" 2>/dev/null || fail "$(tail -n 5 "$1")"
        sleep 0.1
    done
}

# show COMMAND: prints a command, with the programs' names alone, and runs it.
show() {
    local word line='$'
    for word in "$@"; do
        word=${word#"$bin"/}
        [[ $word != *[*?]* ]] || word="'$word'"
        line+=" $word"
    done
    echo "$line"
    "$@"
}

# fly SECONDS
fly() {
    sleep "$1" &
    wait $!
}

# ids_of PATTERN: the processes of the fleet whose names, as given by the demo, match.
ids_of() {
    grep '^DDS domain' demo.log | grep -oE "$1 \([0-9]+\)" | grep -oE '[0-9]+\)' | tr -d ')'
}

# kill_hard PATTERN
kill_hard() {
    local ids
    mapfile -t ids < <(ids_of "$1")
    echo "\$ kill -KILL ${ids[*]}"
    kill -KILL "${ids[@]}" || fail "somebody has ended too early: $(cat demo.log)"
}

echo "Flying for $seconds s ..."
"$here/demo.sh" --bin "$bin" --web off --transport "$transport" --record rec >flight.log 2>demo.log &
demo_pid=$!
for uav in uav1 uav2 uav3; do
    wait_for flight.log "$uav   UP      pose (age" "$demo_pid"
done
fly $((seconds * 3 / 4))
kill_hard 'uav3(\.vision)?'
fly $((seconds - seconds * 3 / 4))
kill_hard '(uav[12](\.vision)?|ground)'
wait "$demo_pid"
demo_pid=

status=0
for file in rec/*.mcap; do
    show "$bin/rabit" recover "$file" || status=1
done
show "$bin/rabit" merge flight.mcap rec/*_recovered.mcap || fail "the recordings cannot be merged"
echo "\$ rabit info flight.mcap | head -n 7"
"$bin/rabit" info flight.mcap | head -n 7
show "$bin/rabit" knew flight.mcap '*' 'uav?/Pose' --plot ages.svg || status=1
# A tenth of a second before the end of uav1's recording: all clocks are this machine's.
time_of() { # time_of KEY FILE: in milliseconds
    local time
    time=$("$bin/rabit" info --json "$2" | grep -o "\"$1\":\"[0-9]*" | head -n 1)
    echo $((${time##*:\"} / 1000000))
}
at=$(($(time_of end_ns rec/uav1_*_recovered.mcap) - $(time_of begin_ns flight.mcap) - 100))
show "$bin/rabit" knew flight.mcap uav1 'uav?/Pose' --at "$((at / 1000)).$((at / 100 % 10))" || status=1
show "$bin/uav_rerun" --world "$here/swarm/world.yaml" rec/uav?_*_recovered.mcap || status=1
echo "All of it is in $PWD"
[ "$web" != off ] || exit "$status"

# On loopback, and in a domain that nobody uses: its port (OMG DDSI-RTPS 2.3, 9.6.1.1) is free.
domain=$((20 + RANDOM % 80))
while grep -q "^ *[0-9]*: [0-9A-F]*:$(printf '%04X' $((7400 + 250 * domain))) " /proc/net/udp; do
    domain=$((20 + RANDOM % 80))
done
"$bin/ground" --config "$here/ground_station/ground.yaml" --domain "$domain" --web "$web" >replay.log 2>ground.log &
pids+=($!)
wait_for ground.log '^Web page: ' "${pids[0]}"
echo "\$ rabit play flight.mcap --loop --domain $domain"
"$bin/rabit" play flight.mcap --loop --domain "$domain" >play.log 2>&1 &
pids+=($!)
wait_for replay.log 'REPLAY of a recording, not live: replay\.' "${pids[1]}"
sed -n 's/^Web page: /The replay is at /p' ground.log
trap 'exit "$status"' INT TERM HUP
echo "Ctrl-C ends it."
wait "${pids[1]}"
fail "the replay has ended: $(tail -n 3 play.log)"
