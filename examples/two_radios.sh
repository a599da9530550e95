# Two emulated radios for demo.sh, which reads this file: a mesh of 10 Mbit/s and a modem of 250 kbit/s. Each aircraft
# has a network namespace with the devices mesh0 and modem0. The ground station has the two bridges on this machine.
# shellcheck shell=bash

# The bridges. The domain is in their names, so that two demos do not meet, and rb, since a real radio may be named mesh0.
radios_mesh=
radios_modem=
radios_spaces=()

# radios_name DOMAIN: sets the names.
radios_name() {
    radios_mesh=rbmesh$1
    radios_modem=rbmodem$1
}

# radios_paths MESH MODEM: prints the section `paths` of a configuration.
radios_paths() {
    printf 'paths:\n  - {name: mesh, interfaces: [%s]}\n  - {name: modem, interfaces: [%s], radio: {budget: 6000B/s}}\n' "$1" "$2"
}

radios_inside() { # radios_inside K: prints the name of the namespace of aircraft K
    echo "rabit_${radios_mesh}_uav$1"
}

# radios_make UAVS: makes bridges and namespaces; radios_remove removes them. Returns 1 if this machine cannot.
radios_make() {
    local k space radio number=91 bridge rate
    radios_remove "$1" 2>/dev/null
    for ((k = 1; k <= $1; k++)); do
        space=$(radios_inside "$k")
        ip netns add "$space" || return 1
        radios_spaces+=("$space")
        ip -n "$space" link set lo up || return 1
    done
    for radio in mesh modem; do
        bridge=$radios_mesh
        [ $radio = mesh ] || bridge=$radios_modem
        ip link add "$bridge" type bridge mcast_snooping 0 && ip link set "$bridge" up &&
            ip address add "10.$number.${radios_mesh#rbmesh}.1/24" dev "$bridge" || return 1
        for ((k = 1; k <= $1; k++)); do
            space=$(radios_inside "$k")
            ip link add "$bridge.$k" type veth peer name "${radio}0" netns "$space" &&
                ip link set "$bridge.$k" master "$bridge" up &&
                ip -n "$space" address add "10.$number.${radios_mesh#rbmesh}.$((k + 1))/24" dev "${radio}0" &&
                ip -n "$space" link set "${radio}0" up || return 1
            rate=10mbit
            [ $radio = mesh ] || rate=250kbit
            tc -n "$space" qdisc add dev "${radio}0" root tbf rate $rate burst 3000 limit 32000 || return 1
        done
        number=$((number + 1))
    done
}

radios_remove() { # radios_remove [UAVS]: removes all that radios_make made, or those of an earlier run
    local k
    for ((k = 1; k <= ${1:-${#radios_spaces[@]}}; k++)); do
        ip netns del "$(radios_inside "$k")"
    done
    ip link del "$radios_mesh"
    ip link del "$radios_modem"
    radios_spaces=()
}
