#!/usr/bin/env bash
# Runs a fleet in containers, and injects faults into its network. See usage() below and README.md.
set -euo pipefail

usage() {
    cat <<'USAGE'
Usage: fleet.sh COMMAND
  up [--secure] [UAVS]        a ground station and UAVS aircraft (default 3) on one network; an aircraft is two
                              containers, uav1 and uav1.vision, and so on. --secure: each with keys of its own, and the
                              page with TLS and a token (`logs ground` says its address)
  run NODE PROGRAM [ARG...]   one more node, running any program of the image
  down                        removes all containers of the fleet, its network and its keys
  status                      one line for each node: state, address, faults
  logs NODE [OPTION...]       what the node has written; the options are those of `docker logs`
  cut NODE [in|out]           the node's network is cut: both ways, or only what comes in, or only what goes out
  loss NODE PERCENT [in|out]  that share of the node's packets is lost, at random
  heal NODE                   ends all faults of the node's network
  radio KBIT|off              all nodes share a medium of KBIT kbit/s: what is more than that in the fleet's network is
                              dropped, by nftables on its bridge, a multicast packet counting once. There is no queue
                              and no delay, and a burst of 16 kB passes; a radio with queues, turns, loss and delay is
                              in tests/integration, for processes without containers. Gone after `down`
  kill NODE                   kill -9
  start NODE                  starts it again, in the same container, with whatever address is free then
  remove NODE                 removes the container; `run` may use the name again
  stop NODE                   SIGTERM, and waits for the end; prints the exit code

Environment:
  FLEET        name of the fleet (default rabit); fleets of different names run beside each other
  IMAGE        image of all nodes (default rabit-fleet); `up` builds it if it is not there
  DOMAIN       DDS domain of `up` (default 7)
  TRANSPORTS   backends of the nodes of `up` in turn, for instance "fastdds cyclonedds"
  CONFIG       folder with a NODE.yaml for each node that is to have its own configuration
  RUN_OPTIONS  more options for `docker run`, for instance "--cpus 0.5 --volume /data:/data"
USAGE
}

fail() {
    echo "fleet.sh: $1" >&2
    exit "${2:-1}"
}

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fleet=${FLEET:-rabit}
image=${IMAGE:-rabit-fleet}
label=rabit.fleet=$fleet

# containers: a line "ID NODE" for each container of the fleet, started here or by compose.
containers() {
    docker ps --all --filter "label=$label" --format \
        '{{.ID}} {{.Label "rabit.node"}}/{{.Label "com.docker.compose.service"}}/{{.Label "com.docker.compose.container-number"}}' |
        sed -e 's|^\([^ ]* [^/][^/]*\)/.*|\1|' -e 's| /ground/1$| ground|' -e 's| /vision/\(.*\)$| uav\1.vision|' -e 's| /\(.*\)/\(.*\)$| \1\2|' | awk 'NF == 2' | sort -k 2V
}

# find_container NODE
find_container() {
    local id node
    while read -r id node; do
        if [ "$node" = "$1" ]; then
            echo "$id"
            return
        fi
    done < <(containers)
    fail "no node '$1' in the fleet '$fleet'; there are: $(containers | awk '{printf "%s ", $2}')" 2
}

# The authority of a fleet with keys is in a volume that no node mounts.
authority=$fleet-authority
folder=/var/lib/rabit

has_keys() {
    docker volume inspect "$authority" >/dev/null 2>&1
}

# with_authority OPTION... IMAGE ARGUMENT...: runs a container with that volume and no network
with_authority() {
    docker run --rm --network none --label "$label" --cap-drop ALL --security-opt no-new-privileges \
        --volume "$authority:$folder" "$@"
}

make_authority() {
    docker volume create --label "$label" "$authority" >/dev/null
    with_authority --entrypoint rabit "$image" keys init "$folder/keys" >/dev/null
}

# give_keys CONTAINER NODE OPTION... -- PROGRAM: makes the keys, and copies the node's own into its
# container
give_keys() {
    local container=$1 node=$2 options=() said
    shift 2
    while [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    said=$(with_authority "${options[@]}" --env MAKE_KEYS="$folder/keys" "$image" "$2" 2>&1) || fail "$node gets no keys: $said"
    with_authority --entrypoint tar "$image" -C "$folder/keys" -c "$node" | docker cp - "$container:$folder" >/dev/null
}

make_network() {
    [ -n "$(docker network ls --quiet --filter "label=$label")" ] ||
        docker network create --label "$label" "$fleet" >/dev/null
}

# run_node NODE PROGRAM [ARG...]
run_node() {
    local node=$1 options=() environment
    shift
    environment=(--env NODE="$node" --env DOMAIN="${DOMAIN:-7}" --env TRANSPORTS="${TRANSPORTS:-}")
    [ -z "${CONFIG:-}" ] || environment+=(--volume "$(cd "$CONFIG" && pwd):/etc/rabit/nodes:ro")
    # shellcheck disable=SC2206 # options are words
    options+=(${RUN_OPTIONS:-})
    ! has_keys || options+=(--env KEYS="$folder/$node")
    docker create --name "$fleet-$node" --hostname "$node" --network "$fleet" --label "$label" \
        --label "rabit.node=$node" --cap-drop ALL --security-opt no-new-privileges \
        "${environment[@]}" "${options[@]}" "$image" "$@" >/dev/null
    case $1 in
    uav | vision | ground) ! has_keys || give_keys "$fleet-$node" "$node" "${environment[@]}" -- "$1" ;;
    esac
    docker start "$fleet-$node" >/dev/null
}

up() {
    local page=(--web-open-to-everybody-on-the-network) secure="" uavs k
    if [ "${1:-}" = --secure ]; then
        secure=yes page=()
        shift
    fi
    uavs=${1:-${UAVS:-3}}
    [[ $uavs =~ ^[1-9][0-9]{0,2}$ ]] || fail "up takes a number of aircraft from 1 to 999, not '$uavs'" 2
    docker image inspect "$image" >/dev/null 2>&1 ||
        docker build --tag "$image" --file "$here/Dockerfile" "$here/.."
    [ -z "$secure" ] || has_keys || make_authority
    make_network
    run_node ground ground --web 0.0.0.0:8080 "${page[@]}" --search '*' --search-area 47.3977 8.5456 400 600 510
    for ((k = 1; k <= uavs; k++)); do
        run_node "uav$k" uav
        run_node "uav$k.vision" vision
    done
}

# filter CONTAINER [NFT OPTION...]: nft in the container's network. The nodes lack the capability NET_ADMIN,
# so a short-lived container that has it does this.
filter() {
    local id=$1
    shift
    docker run --rm --interactive --network "container:$id" --label "$label" --user 0 \
        --cap-drop ALL --cap-add NET_ADMIN --entrypoint nft "$image" "$@"
}

# set_loss NODE PERCENT in|out|both. Packets are dropped at the interface, inbound and outbound, where the
# sender's socket gets no error.
set_loss() {
    local id percent=$2 direction=$3 chain hook rule
    id=$(find_container "$1")
    [[ $percent =~ ^[0-9]{1,3}$ ]] && [ "$percent" -le 100 ] || fail "PERCENT is a number from 0 to 100" 2
    case $direction in
    in) set -- ingress ;;
    out) set -- egress ;;
    both) set -- ingress egress ;;
    *) fail "a direction is 'in' or 'out', not '$direction'" 2 ;;
    esac
    rule=drop
    [ "$percent" -eq 100 ] || rule="numgen random mod 100 < $percent drop"
    {
        echo "add table netdev rabit"
        for hook in "$@"; do
            chain="add chain netdev rabit $hook"
            echo "$chain { type filter hook $hook device \"eth0\" priority 0; }"
            echo "flush chain netdev rabit $hook"
            echo "add rule netdev rabit $hook $rule"
        done
    } | filter "$id" -f -
}

heal() {
    local id
    id=$(find_container "$1")
    printf 'add table netdev rabit\ndelete table netdev rabit\n' | filter "$id" -f -
}

# subnets: a line "NETWORK_ID SUBNET" for the fleet's network
subnets() {
    docker network ls --no-trunc --quiet --filter "label=$label" | while read -r id; do
        docker network inspect --format '{{.Id}}{{range .IPAM.Config}} {{.Subnet}}{{end}}' "$id"
    done | awk '{for (i = 2; i <= NF; i++) if ($i ~ /\./) print $1, $i}'
}

# radio_table NETWORK_ID: names a table of its own for each network
radio_table() {
    echo "bridge rabit_${1:0:12}"
}

# on_bridge NFT OPTION...: nft in the network namespace of the engine's bridges
on_bridge() {
    docker run --rm --interactive --network host --label "$label" --user 0 \
        --cap-drop ALL --cap-add NET_ADMIN --entrypoint nft "$image" "$@"
}

# set_radio KBIT|off. Packets count where they enter the bridge, before they are copied to their receivers.
set_radio() {
    local network subnet table
    [ "$1" = off ] || [[ $1 =~ ^[1-9][0-9]{0,6}$ ]] || fail "KBIT is a number from 1 to 9999999, or 'off'" 2
    while read -r network subnet; do
        table=$(radio_table "$network")
        {
            printf 'add table %s\ndelete table %s\n' "$table" "$table"
            if [ "$1" != off ]; then
                printf 'table %s {\nchain air {\n' "$table"
                echo "type filter hook prerouting priority -300; policy accept;"
                echo "ip saddr $subnet limit rate over $(($1 * 125)) bytes/second burst 16000 bytes counter drop"
                printf '}\n}\n'
            fi
        } | on_bridge -f -
    done < <(subnets)
}

# radio_status: describes the limit of set_radio
radio_status() {
    local network subnet
    while read -r network subnet; do
        { on_bridge list table "$(radio_table "$network")" </dev/null 2>/dev/null || true; } | sed -n \
            's/.*limit rate over \(.*\) burst.* counter packets \([0-9]*\) .*/RADIO        \1, \2 packets dropped/p'
    done < <(subnets)
}

# faults CONTAINER: describes the faults of set_loss
faults() {
    { filter "$1" list table netdev rabit </dev/null 2>/dev/null || true; } | awk '
        $1 == "chain" { way = $2 == "ingress" ? "in" : "out" }
        $1 == "drop" { printf "%s cut ", way }
        $1 == "numgen" { printf "%s %s %% lost ", way, $6 }'
}

# status_of CONTAINER NODE
status_of() {
    local state address set=
    state=$(docker inspect --format '{{.State.Status}}' "$1")
    address=$(docker inspect --format '{{range .NetworkSettings.Networks}}{{.IPAddress}}{{end}}' "$1")
    [ "$state" != running ] || set=$(faults "$1")
    printf '%-12s %-12s %-16s %s\n' "$2" "$state" "$address" "$set"
}

status() {
    local id node
    printf '%-12s %-12s %-16s %s\n' NODE STATE ADDRESS FAULTS
    while read -r id node; do
        status_of "$id" "$node" </dev/null &
    done < <(containers) | sort -V # sort waits for all of them
    radio_status
}

down() {
    local ids
    ! docker image inspect "$image" >/dev/null 2>&1 || set_radio off
    ids=$(docker ps --all --quiet --filter "label=$label")
    # shellcheck disable=SC2086 # one word for each
    [ -z "$ids" ] || docker rm --force --volumes $ids >/dev/null
    ids=$(docker network ls --quiet --filter "label=$label")
    # shellcheck disable=SC2086
    [ -z "$ids" ] || docker network rm $ids >/dev/null
    ids=$(docker volume ls --quiet --filter "label=$label")
    # shellcheck disable=SC2086
    [ -z "$ids" ] || docker volume rm $ids >/dev/null
}

# need COUNT "$@": checks the number of arguments after the command
need() {
    [ $(($# - 2)) -ge "$1" ] || fail "$2 needs more arguments (fleet.sh --help)" 2
}

command=${1:---help}
case $command in
-h | --help) usage ;;
up) up "${@:2}" ;;
down) down ;;
status) status ;;
run)
    need 2 "$@"
    make_network
    run_node "${@:2}"
    ;;
logs)
    need 1 "$@"
    docker logs "${@:3}" "$(find_container "$2")"
    ;;
cut)
    need 1 "$@"
    set_loss "$2" 100 "${3:-both}"
    ;;
loss)
    need 2 "$@"
    set_loss "$2" "$3" "${4:-both}"
    ;;
heal)
    need 1 "$@"
    heal "$2"
    ;;
radio)
    need 1 "$@"
    [ -n "$(subnets)" ] || fail "the fleet '$fleet' has no network" 2
    set_radio "$2"
    ;;
kill)
    need 1 "$@"
    docker kill "$(find_container "$2")" >/dev/null
    ;;
start)
    need 1 "$@"
    docker start "$(find_container "$2")" >/dev/null
    ;;
remove)
    need 1 "$@"
    docker rm --force --volumes "$(find_container "$2")" >/dev/null
    ;;
stop)
    need 1 "$@"
    id=$(find_container "$2")
    docker stop --time 20 "$id" >/dev/null
    docker inspect --format '{{.State.ExitCode}}' "$id"
    ;;
*) fail "unknown command '$command' (fleet.sh --help)" 2 ;;
esac
