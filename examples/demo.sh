#!/usr/bin/env bash
# Flies a simulated fleet on this machine and shows it at a ground station. See usage() below and examples/README.md.
set +m -uo pipefail # no job control: processes started with & keep the process id that $! names

usage() {
    cat <<'USAGE'
Usage: demo.sh [OPTION]...
Starts simulated aircraft and a ground station as processes of their own on this machine, joined by DDS over
loopback, and shows the fleet until Ctrl-C. Installs missing Debian packages and builds what is missing first.

  --uavs N           number of aircraft, 1 to 20 (default 3); they are called uav1, uav2, ...
  --seconds N        end after N seconds, 1 to 86400 (default: run until Ctrl-C)
  --track FILE       let an aircraft fly the track in this CSV file; the first --track is for uav1, the second for
                     uav2, and so on; aircraft without one fly circles
  --transport NAME   DDS implementation: fastdds (default), cyclonedds, or mixed: uav1, uav3, ... and the ground station
                     on fastdds, uav2, uav4, ... on cyclonedds
  --domain N         DDS domain, 0 to 232 (default: one that nobody on this machine uses)
  --bin DIR          take the programs uav and ground from this folder; install and build nothing
  -h, --help         show this and exit

Exit code: 0 if every aircraft was up at the end, at least 90 % of the poses that it published were heard, and every
command was acknowledged by the aircraft it was meant for; 1 if not; 2 if an option or a track file is wrong.
USAGE
}

fail_usage() {
    echo "demo.sh: $1 (--help shows the options)" >&2
    exit 2
}

# is_number TEXT MIN MAX
is_number() {
    [[ $1 =~ ^[0-9]{1,6}$ ]] && [ "$((10#$1))" -ge "$2" ] && [ "$((10#$1))" -le "$3" ]
}

# A script that starts this one with & hands it an ignored SIGINT, which bash cannot trap: start again with it restored.
ignored=$(sed -n 's/^SigIgn:[[:space:]]*//p' /proc/$$/status)
if ((0x${ignored:-0} & 2)); then
    exec env --default-signal=INT "$BASH" "${BASH_SOURCE[0]}" "$@"
fi

uavs=3
seconds=
tracks=()
transport=fastdds
domain=
bin=
while [ $# -gt 0 ]; do
    option=$1
    case $option in
    -h | --help)
        usage
        exit 0
        ;;
    --*=*) # --option=value
        set -- "${option%%=*}" "${option#*=}" "${@:2}"
        continue
        ;;
    --uavs | --seconds | --track | --transport | --domain | --bin)
        [ $# -ge 2 ] || fail_usage "$option needs a value"
        value=$2
        shift 2
        ;;
    *) fail_usage "unknown option '$option'" ;;
    esac
    case $option in
    --uavs)
        is_number "$value" 1 20 || fail_usage "--uavs must be a number from 1 to 20, not '$value'"
        uavs=$((10#$value))
        ;;
    --seconds)
        is_number "$value" 1 86400 || fail_usage "--seconds must be a number from 1 to 86400, not '$value'"
        seconds=$((10#$value))
        ;;
    --track) tracks+=("$value") ;;
    --transport)
        [[ $value =~ ^(fastdds|cyclonedds|mixed)$ ]] ||
            fail_usage "--transport must be fastdds, cyclonedds or mixed, not '$value'"
        transport=$value
        ;;
    --domain)
        is_number "$value" 0 232 || fail_usage "--domain must be a number from 0 to 232, not '$value'"
        domain=$((10#$value))
        ;;
    --bin) bin=$value ;;
    esac
done
[ ${#tracks[@]} -le "$uavs" ] ||
    fail_usage "${#tracks[@]} tracks are too many for --uavs $uavs"

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$here")
if [ -z "$bin" ]; then
    "$root/docker/install-packages.sh" || exit 1
    "$root/docker/build-preset.sh" release uav ground || exit 1
    bin=$root/build/release/bin
fi
for program in uav ground; do
    [ -x "$bin/$program" ] || fail_usage "there is no program $bin/$program"
done

# The UDP port that every process of a DDS domain listens on (OMG DDSI-RTPS 2.3, 9.6.1.1), in hexadecimal.
domain_in_use() {
    local port
    port=$(printf '%04X' $((7400 + 250 * $1)))
    grep -q "^ *[0-9]*: [0-9A-F]*:$port " /proc/net/udp /proc/net/udp6 2>/dev/null
}

# Domains from 20 to 99: their ports stay below those that the kernel gives to any program.
if [ -z "$domain" ]; then
    first=$((RANDOM % 80))
    for ((i = 0; i < 80; i++)); do
        domain=$((20 + (first + i) % 80))
        domain_in_use "$domain" || break
    done
fi

# Everything is checked before anything is started.
transport_of() { # transport_of K: prints the transport of aircraft K; the ground station is number 1
    case $transport-$(($1 % 2)) in
    mixed-1) echo fastdds ;;
    mixed-0) echo cyclonedds ;;
    *) echo "$transport" ;;
    esac
}
uav_arguments() { # uav_arguments K: sets the array `arguments`
    arguments=(--config "$here/swarm/uav.yaml" --node "uav$1" --domain "$domain"
        --transport "$(transport_of "$1")")
    [ "$1" -gt ${#tracks[@]} ] || arguments+=(--track "${tracks[$1 - 1]}")
}
ground_arguments=(--config "$here/ground_station/ground.yaml" --domain "$domain"
    --transport "$(transport_of 1)")
[ -z "$seconds" ] || ground_arguments+=(--seconds "$seconds")
for ((k = 1; k <= uavs; k++)); do
    ground_arguments+=(--expect "uav$k")
    uav_arguments "$k"
    "$bin/uav" "${arguments[@]}" --check || exit $?
done
"$bin/ground" "${ground_arguments[@]}" --check || exit $?

logs=$(mktemp -d)
uav_pids=()
ground_pid=
interrupts=0

# Ends the processes given: politely, and after 5 seconds for good.
end_processes() {
    local pid tries
    kill -TERM "$@" 2>/dev/null
    for ((tries = 0; tries < 50; tries++)); do
        kill -0 "$@" 2>/dev/null || break
        sleep 0.1
    done
    for pid in "$@"; do
        kill -KILL "$pid" 2>/dev/null
        wait "$pid" 2>/dev/null
    done
}

on_exit() {
    trap - EXIT
    trap '' INT TERM HUP
    end_processes ${ground_pid:+"$ground_pid"} "${uav_pids[@]}"
    rm -rf "$logs"
}

# The first time the ground station ends in its own time, with its summary; the second time everything ends at once.
on_interrupt() {
    interrupts=$((interrupts + 1))
    [ -n "$ground_pid" ] || exit 130
    if [ "$interrupts" -eq 1 ]; then
        kill -INT "$ground_pid" 2>/dev/null
    else
        kill -KILL "$ground_pid" 2>/dev/null
    fi
}
trap on_exit EXIT
trap on_interrupt INT TERM HUP

# A session of its own for each process keeps the terminal's Ctrl-C from all but this script, which ends them in the
# right order. The parent-death signal ends them even if this script is killed.
started=
for ((k = 1; k <= uavs; k++)); do
    uav_arguments "$k"
    setsid setpriv --pdeathsig TERM "$bin/uav" "${arguments[@]}" </dev/null >"$logs/uav$k" 2>&1 &
    uav_pids+=($!)
    started+="${started:+, }uav$k ($!)"
done
setsid setpriv --pdeathsig TERM "$bin/ground" "${ground_arguments[@]}" </dev/null &
ground_pid=$!
echo "DDS domain $domain. Processes: $started, ground ($ground_pid). Ctrl-C ends them." >&2

# From here on the shell's own notices, for instance of an aircraft that was killed, would spoil the table.
exec 3>&2 2>/dev/null
while true; do
    seen=$interrupts
    wait "$ground_pid"
    status=$?
    [ "$interrupts" -ne "$seen" ] || break
done
ground_pid=

result=0
if [ "$status" -ne 0 ]; then
    [ "$status" -eq 1 ] || echo "demo.sh: ground ended with exit code $status" >&3
    result=1
fi
for ((k = 1; k <= uavs; k++)); do
    if ! kill -0 "${uav_pids[k - 1]}"; then
        wait "${uav_pids[k - 1]}"
        echo "demo.sh: uav$k ended before its time with exit code $?" >&3
        tail -n 5 "$logs/uav$k" | sed "s/^/    uav$k: /" >&3
        result=1
    fi
done
exit "$result"
