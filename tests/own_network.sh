# For tests that would disturb each other on the loopback of one machine; to be sourced.
#
# enter_own_network ARGUMENT...: starts this script again, with these arguments, in a network of its own, which vanishes with
# it: a loopback and an Ethernet with an address and a default route, as a person's machine has. If the machine forbids
# that, the script goes on in the machine's network. A script that needs the Internet uses it before this call.
# Nothing of the network changes later: an IPv6 address would come a second or two after, and a browser then breaks off its
# downloads.
enter_own_network() {
    [ -z "${RABIT_TEST_IN_NAMESPACE:-}" ] || return 0
    export RABIT_TEST_IN_NAMESPACE=no
    unshare --net ip link set lo up 2>/dev/null || return 0
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

# free_domain: prints a DDS domain for this script: 0 in a network of its own, else one whose port no process of this machine
# has.
free_domain() {
    local domain=0 first=$((RANDOM % 80)) i
    if [ "${RABIT_TEST_IN_NAMESPACE:-}" != yes ]; then
        for ((i = 0; i < 80; i++)); do
            domain=$((20 + (first + i) % 80))
            grep -q "$(printf ':%04X ' $((7400 + 250 * domain)))" /proc/net/udp || break
        done
    fi
    echo "$domain"
}
