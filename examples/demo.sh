#!/usr/bin/env bash
# Flies a simulated fleet on this machine and shows it at a ground station. See usage() below and examples/README.md.
set +m -uo pipefail # no job control: processes started with & keep the process id that $! names

usage() {
    cat <<'USAGE'
Usage: demo.sh [OPTION]...
Starts simulated aircraft that search an area for targets, and a ground station, joined by DDS over loopback, and shows
the fleet until Ctrl-C, here and on a web page. An aircraft is two processes, uav1 and uav1.vision, and so on. Installs
missing Debian packages and builds what is missing first.

  --uavs N           number of aircraft, 1 to 20 (default 3); they are called uav1, uav2, ...
  --seconds N        end after N seconds, 1 to 86400 (default: run until Ctrl-C)
  --track FILE       let an aircraft fly the track in this CSV file; the first --track is for uav1, the second for
                     uav2, and so on; they follow it and do not search
  --web PORT         port of the web page on this machine, 1 to 65535 (default: the first free one from 8080 on), or `off`
  --transport NAME   DDS implementation: fastdds (default if it is built), cyclonedds, or mixed: uav1, uav3, ... and the ground station
                     on fastdds, uav2, uav4, ... on cyclonedds
  --radios two       each aircraft has two emulated radios, a fast mesh and a slow modem; needs root and iproute2. The
                     script prints how to cut the mesh
  --secure           with fresh keys, a folder for each node: strangers are neither heard nor answered
  --domain N         DDS domain, 0 to 232, that nobody on this machine uses (default: one that is free)
  --record DIR       let each process record itself into this folder: see black_box.sh
  --bin DIR          take the programs uav, vision and ground, and with --secure rabit, from this folder; install and
                     build nothing
  -h, --help         show this and exit

Exit code: 0 if every aircraft was up at the end, at least 90 % of the poses that it published were heard, every command
was acknowledged by the aircraft it was meant for or certainly never reached it, and, if two aircraft or more search, a
target was found by one of them, validated by another and followed, which takes them about a minute; 1 if not; 2 if an
option or a track file is wrong, or the domain is in use.
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
transport=
domain=
bin=
web=
record=
secure=
radios=
while [ $# -gt 0 ]; do
    option=$1
    case $option in
    -h | --help)
        usage
        exit 0
        ;;
    --secure)
        secure=yes
        shift
        continue
        ;;
    --*=*) # --option=value
        set -- "${option%%=*}" "${option#*=}" "${@:2}"
        continue
        ;;
    --uavs | --seconds | --track | --transport | --domain | --web | --record | --radios | --bin)
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
    --web)
        [ "$value" = off ] || is_number "$value" 1 65535 ||
            fail_usage "--web must be a port from 1 to 65535, or off, not '$value'"
        web=$value
        ;;
    --record) record=$value ;;
    --radios)
        [ "$value" = two ] || fail_usage "--radios must be two, not '$value'"
        radios=$value
        ;;
    --bin) bin=$value ;;
    esac
done
[ ${#tracks[@]} -le "$uavs" ] ||
    fail_usage "${#tracks[@]} tracks are too many for --uavs $uavs"
[ -z "$radios" ] || { [ "$(id -u)" -eq 0 ] && command -v ip tc >/dev/null; } ||
    fail_usage "--radios two needs root and iproute2"
for track in "${tracks[@]}"; do
    [ -f "$track" ] && [ -r "$track" ] || fail_usage "--track: there is no file '$track' that can be read"
done

# The UDP port that every process of a DDS domain listens on (OMG DDSI-RTPS 2.3, 9.6.1.1), in hexadecimal.
domain_in_use() {
    local port
    port=$(printf '%04X' $((7400 + 250 * $1)))
    grep -q "^ *[0-9]*: [0-9A-F]*:$port " /proc/net/udp /proc/net/udp6 2>/dev/null
}

# Two nodes of one name would share orders and answers: both fleets would be shown wrong.
[ -z "$domain" ] || ! domain_in_use "$domain" ||
    fail_usage "a program of this machine is in DDS domain $domain already: end it, or leave out --domain"

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$here")
programs=(uav vision ground)
[ -z "$secure" ] || programs+=(rabit)
if [ -z "$bin" ]; then
    "$root/docker/install-packages.sh" || exit 1
    "$root/docker/build-preset.sh" release "${programs[@]}" || exit 1
    bin=$root/build/release/bin
fi
if [ -z "$transport" ]; then
    transport=fastdds
    ! grep -qs '^RABIT_WITH_FASTDDS:BOOL=OFF' "$bin/../CMakeCache.txt" || transport=cyclonedds
fi
for program in "${programs[@]}"; do
    [ -x "$bin/$program" ] || fail_usage "there is no program $bin/$program"
done

# tcp_port_in_use PORT: true if a program listens on it.
tcp_port_in_use() {
    local port
    port=$(printf '%04X' "$1")
    grep -q "^ *[0-9]*: [0-9A-F]*:$port [0-9A-F]*:0000 0A " /proc/net/tcp /proc/net/tcp6 2>/dev/null
}
if [ -z "$web" ]; then
    web=8080
    while tcp_port_in_use "$web" && [ "$web" -lt 8180 ]; do web=$((web + 1)); done
fi

# Domains from 20 to 99: their ports stay below those that the kernel gives to any program.
if [ -z "$domain" ]; then
    first=$((RANDOM % 80))
    for ((i = 0; i < 80; i++)); do
        domain=$((20 + (first + i) % 80))
        domain_in_use "$domain" || break
    done
fi

# Recordings and radios are sections of each configuration.
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT
if [ -n "$record" ]; then
    mkdir -p -- "$record" || exit 2
    record=$(cd -- "$record" && pwd) || exit 2
fi
config_of() { # config_of FILE MESH MODEM [LINE]: prints the configuration to use; the line stands in its section `record`
    local copy
    copy=$logs/$(basename "$1")
    if [ -z "$record$radios" ]; then
        echo "$1"
        return
    fi
    {
        if [ -n "$radios" ]; then
            grep -v '^interfaces:' "$1"
            radios_paths "$2" "$3"
        else
            cat "$1"
        fi
        [ -z "$record" ] ||
            printf 'record:\n  folder: '"'%s'"'\n  free: 100MB\n%s' "${record//\'/\'\'}" "${4:+  $4$'\n'}"
    } >"$copy"
    echo "$copy"
}
# shellcheck source=examples/two_radios.sh
. "$here/two_radios.sh"
radios_name "$domain"
uav_config=$(config_of "$here/swarm/uav.yaml" mesh0 modem0 'steps: [MissionControl, HealthMonitor]')
vision_config=$(config_of "$here/swarm/vision.yaml" mesh0 modem0)
ground_config=$(config_of "$here/ground_station/ground.yaml" "$radios_mesh" "$radios_modem")

# Everything is checked before anything is started.
transport_of() { # transport_of K: prints the transport of aircraft K; the ground station is number 1
    case $transport-$(($1 % 2)) in
    mixed-1) echo fastdds ;;
    mixed-0) echo cyclonedds ;;
    *) echo "$transport" ;;
    esac
}
# The keys of a node allow exactly the needs of its configuration.
keys=
if [ -n "$secure" ]; then
    keys=$(mktemp -d)
    trap 'rm -rf "$logs" "$keys"' EXIT
    said=$("$bin/rabit" keys init "$keys/fleet" 2>&1) || fail_usage "$said"
fi
make_keys() { # make_keys NODE OPTION...
    [ -z "$keys" ] || said=$("$bin/rabit" keys add "$1" --keys "$keys/fleet" "${@:2}" 2>&1) || fail_usage "$said"
}
keys_argument() { # keys_argument NODE: adds to the array `arguments`
    [ -z "$keys" ] || arguments+=(--keys "$keys/fleet/$1")
}
uav_arguments() { # uav_arguments K: sets the array `arguments`
    arguments=(--config "$uav_config" --node "uav$1" --domain "$domain"
        --transport "$(transport_of "$1")")
    keys_argument "uav$1"
    # A recorded track may lie anywhere, over ground that differs from the simulated world's.
    if [ "$1" -le ${#tracks[@]} ]; then
        arguments+=(--track "${tracks[$1 - 1]}")
    else
        arguments+=(--world "$here/swarm/world.yaml")
    fi
}
vision_arguments() { # vision_arguments K: sets the array `arguments`
    arguments=(--config "$vision_config" --node "uav$1.vision" --domain "$domain"
        --transport "$(transport_of "$1")" --world "$here/swarm/world.yaml")
    keys_argument "uav$1.vision"
}
arguments=(--config "$ground_config" --domain "$domain" --transport "$(transport_of 1)")
keys_argument ground
ground_arguments=("${arguments[@]}" --search-area 47.3977 8.5456 400 600 510)
make_keys ground --config "$ground_config"
make_keys laptop --tool
among=()
among_radios() { # among_radios K: sets the array `among`, the words before a command that runs where aircraft K has its radios
    [ -z "$radios" ] || among=(ip netns exec "$(radios_inside "$1")")
}
if [ -n "$radios" ]; then
    trap 'rm -rf "$logs" ${keys:+"$keys"}; radios_remove 2>/dev/null' EXIT
    radios_make "$uavs" || fail_usage "--radios two: no such networks can be made here"
fi
[ -z "$seconds" ] || ground_arguments+=(--seconds "$seconds")
[ "$web" = off ] || ground_arguments+=(--web "$web")
[ $((uavs - ${#tracks[@]})) -lt 2 ] || ground_arguments+=(--expect-target)
for ((k = 1; k <= uavs; k++)); do
    ground_arguments+=(--expect "uav$k")
    [ "$k" -le ${#tracks[@]} ] || ground_arguments+=(--search "uav$k")
    make_keys "uav$k" --config "$uav_config"
    make_keys "uav$k.vision" --config "$vision_config"
    among_radios "$k"
    uav_arguments "$k"
    "${among[@]}" "$bin/uav" "${arguments[@]}" --check || exit $?
    vision_arguments "$k"
    "${among[@]}" "$bin/vision" "${arguments[@]}" --check || exit $?
done
"$bin/ground" "${ground_arguments[@]}" --check || exit $?

# idle_processors: how much of the processors that this script may use is idle now, in hundredths of one.
idle_processors() {
    local before
    before=$(cat /proc/stat)
    sleep 0.3
    awk -v ours="$(sed -n 's/^Cpus_allowed_list:[[:space:]]*//p' /proc/self/status)" '
        BEGIN {
            count = split(ours, parts, ",")
            for (i = 1; i <= count; i++) {
                ends = split(parts[i], range, "-")
                for (k = range[1]; k <= range[ends]; k++) may["cpu" k] = 1
            }
        }
        $1 in may {
            sum = 0
            for (i = 2; i <= 9; i++) sum += $i
            if ($1 in all && sum > all[$1]) idle += 100 * ($5 + $6 - rest[$1]) / (sum - all[$1])
            all[$1] = sum
            rest[$1] = $5 + $6
        }
        END { printf "%d\n", idle }' <(echo "$before") /proc/stat
}

# A simulated aircraft and its share of the ground station took 0.04 of a processor of 2.6 GHz where twenty flew.
hundredths() { printf '%d.%02d' $(($1 / 100)) $(($1 % 100)); }
needed=$((4 * uavs))
idle=$(idle_processors)
[ "$needed" -le "$idle" ] || echo "demo.sh: $uavs aircraft need about $(hundredths "$needed") of a processor, and" \
    "$(hundredths "$idle") is idle: they may start late, and be STALE at times" >&2

names=()  # of the processes of the aircraft, and their ids, in the same order
pids=()
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
    end_processes ${ground_pid:+"$ground_pid"} "${pids[@]}"
    [ -z "$radios" ] || radios_remove 2>/dev/null
    rm -rf "$logs" ${keys:+"$keys"}
}

# The first time the ground station ends in an orderly way, with its summary; the second time everything
# ends at once.
on_interrupt() {
    interrupts=$((interrupts + 1))
    [ -n "$ground_pid" ] || exit 130
    if [ "$interrupts" -eq 1 ]; then
        kill -TERM "$ground_pid" 2>/dev/null
    else
        kill -KILL "$ground_pid" 2>/dev/null
    fi
}
trap on_exit EXIT
trap on_interrupt INT TERM HUP

# A session of its own for each process keeps the terminal's Ctrl-C from all but this script, which ends them in the
# right order. The parent-death signal ends them even if this script is killed.
started=
start() { # start NAME PROGRAM: with the arrays `arguments` and `among`
    setsid setpriv --pdeathsig TERM "${among[@]}" "$bin/$2" "${arguments[@]}" </dev/null >"$logs/$1" 2>&1 &
    names+=("$1")
    pids+=($!)
    started+="${started:+, }$1 ($!)"
}
for ((k = 1; k <= uavs; k++)); do
    among_radios "$k"
    uav_arguments "$k"
    start "uav$k" uav
    vision_arguments "$k"
    start "uav$k.vision" vision
done
setsid setpriv --pdeathsig TERM "$bin/ground" "${ground_arguments[@]}" </dev/null &
ground_pid=$!
echo "DDS domain $domain. Processes: $started, ground ($ground_pid). Ctrl-C ends them." >&2
[ -z "$radios" ] || echo "Radios: the mesh is $radios_mesh, the modem $radios_modem. To cut the mesh: ip link set $radios_mesh down;" \
    "to mend it: ip link set $radios_mesh up" >&2
interface=lo
[ -z "$radios" ] || interface=$radios_mesh
[ -z "$keys" ] || echo "Strangers are kept out. To look at it: $bin/rabit nodes --keys $keys/fleet/laptop --domain $domain" \
    "--transport $(transport_of 1) --interface $interface" >&2

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
for k in "${!pids[@]}"; do
    if ! kill -0 "${pids[k]}"; then
        wait "${pids[k]}"
        echo "demo.sh: ${names[k]} ended before its time with exit code $?" >&3
        tail -n 5 "$logs/${names[k]}" | sed "s/^/    ${names[k]}: /" >&3
        result=1
    fi
done
exit "$result"
