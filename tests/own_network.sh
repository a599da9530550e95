# For tests that would get into each other's way on the loopback of one machine; to be sourced.
#
# enter_own_network ARGUMENT...: starts this script again, with these arguments, in a network of its own, which vanishes with
# it: a loopback and an Ethernet with an address and the way to everywhere, as a person's machine has. Where it may not
# make one, it goes on in that of the machine. A script that needs what is outside gets it before.
# Nothing of it changes later: an address of IPv6 would come a second or two after, and then a browser breaks off what it
# loads.
enter_own_network() {
    [ -z "${RABIT_TEST_IN_NAMESPACE:-}" ] || return 0
    export RABIT_TEST_IN_NAMESPACE=no
    unshare --net true 2>/dev/null || return 0
    export RABIT_TEST_IN_NAMESPACE=yes
    # shellcheck disable=SC2016 # for the inner shell
    exec unshare --net sh -ec '
        ip link set lo up
        ip link add eth0 type veth peer name neighbour
        for link in eth0 neighbour; do
            ip link set "$link" addrgenmode none
            ip link set "$link" up
        done
        ip address add 192.0.2.2/24 dev eth0
        ip route add default via 192.0.2.1
        exec "$@"' sh "$BASH" "$0" "$@"
}
