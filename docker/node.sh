#!/bin/sh
# The entry point of the image. Usage: rabit-node uav|vision|ground [OPTION...], or rabit-node PROGRAM [ARGUMENT...].
# uav, vision and ground take name, configuration, backend and keys from the variables in README.md. If
# MAKE_KEYS is set, to the folder of a fleet's keys, this only makes the node's keys there and does not run
# the node.
set -eu

# A replica of a compose service can learn its number only from the network's name server:
# PROJECT-SERVICE-NUMBER.
name_on_network() {
    getent -s dns hosts "$(hostname -i | cut -d ' ' -f 1)" | awk '{print $2}' | sed -n "s/^[^.]*$1[-_]\([0-9]*\)\..*/\1/p"
}

case ${1:-} in
uav | vision | ground) ;;
*) exec "$@" ;;
esac
role=$1
shift
if [ -z "${NODE:-}" ]; then
    NODE=ground
    if [ "$role" != ground ]; then
        number=$(name_on_network "$role")
        if [ -z "$number" ]; then
            echo "rabit-node: no name: set NODE, for instance to uav1, or for vision to uav1.vision" >&2
            exit 2
        fi
        NODE=uav$number
        [ "$role" = uav ] || NODE=$NODE.vision
    fi
fi

config=/etc/rabit/nodes/$NODE.yaml
[ -f "$config" ] || config=/etc/rabit/$role.yaml

if [ -n "${MAKE_KEYS:-}" ]; then
    exec rabit keys add "$NODE" --keys "$MAKE_KEYS" --config "$config"
fi
# The backends in turn: the ground station and uav1 have the first, uav2 the second, and so on, round robin.
if [ -n "${TRANSPORTS:-}" ]; then
    number=$(expr "${NODE%.vision}" : '.*[^0-9]0*\([0-9][0-9]*\)$' || echo 1)
    count=$(echo "$TRANSPORTS" | wc -w)
    wanted=$(((${number:-1} - 1) % count + 1))
    set -- --transport "$(echo "$TRANSPORTS" | awk -v n="$wanted" '{print $n}')" "$@"
fi
[ -z "${KEYS:-}" ] || set -- --keys "$KEYS" "$@"
# The simulated world; a real aircraft flies over other ground.
case "$role $*" in
ground* | *--mavlink*) ;;
*) set -- --world /usr/local/share/rabit/world.yaml "$@" ;;
esac
[ -z "${DOMAIN:-}" ] || set -- --domain "$DOMAIN" "$@"
exec "$role" --config "$config" --node "$NODE" "$@"
