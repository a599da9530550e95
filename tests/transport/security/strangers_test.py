#!/usr/bin/env python3
"""What is not let into a fleet with keys: nodes without keys, nodes of another fleet, and recordings of the fleet itself. Nodes
beside two members hear nothing of them, are not heard, and get no answer. Nothing that members send can be read, and members
say that somebody is there.

Usage: strangers_test.py RABIT LEDGER_NODE TRANSPORT...
Skipped (exit code 77) where no network namespace can be made: the test reads all datagrams on loopback."""

import re
import sys

import keyed_fleet
import loopback
from keyed_fleet import Node, fleet_keys, harness, meet

MEMBERS = ("hushed0", "hushed1")  # no stranger knows these names
SECRET = b"hushed"
STRANGERS = ("stranger", "witness")  # they hear each other
NO_KEYS = "a program without keys sends there"
OTHER_KEYS = "it has keys of another fleet"
LEAST = 100  # datagrams that are looked at
RECORDED = 100  # ticks


class Case(keyed_fleet.Case):
    def __init__(self, *how):
        super().__init__(*how, outsiders=STRANGERS)
        self.seen = []  # (source port, destination port, datagram), of this domain


def stay_apart(case, keys):
    """Strangers that have met, and members that meet beside them."""
    strangers = [Node(case, name, "--ticks", keys=keys.get(name)) for name in STRANGERS]
    meet(*strangers)
    members = case.talkers(*MEMBERS)
    keyed_fleet.exchange(*members)
    return members, strangers


def check_apart(case, members, strangers):
    """After that the strangers have had all the time that they needed to be noticed."""
    keyed_fleet.exchange(*members, count=60)
    keyed_fleet.once_and_in_order(*members)
    for nodes, others in ((members, strangers), (strangers, members)):
        for node in nodes:
            for other in others:
                node.never(f"(peer node|delivered from|tick from)={other.name} .*")
    own = set().union(*(loopback.ports_of(node.process.pid) for node in members))
    theirs = set().union(*(loopback.ports_of(node.process.pid) for node in strangers)) - own
    sent = [(destination, datagram) for source, destination, datagram in list(case.seen) if source in own]
    assert len(sent) >= LEAST and theirs, f"{len(sent)} datagrams of members were seen"
    # One zero byte wakes up a thread of the vendor.
    plain = [datagram[:80] for _, datagram in sent if datagram[:1] not in (b"", b"\0") and datagram[0] >> 6 != 2]
    assert not plain, f"members sent in plain: {plain[:3]}"
    answers = [destination for destination, _ in sent if destination in theirs]
    assert not answers, f"members sent to the strangers' ports {answers[:3]}"
    readable = [datagram[:80] for _, _, datagram in list(case.seen) if SECRET in datagram]
    assert not readable, f"the name of a member is in {readable[:3]}"


def no_keys(case):
    """nodes without keys"""
    members, strangers = stay_apart(case, {})
    for member in members:
        member.says(NO_KEYS)
    check_apart(case, members, strangers)


def other_keys(case):
    """nodes of another fleet"""
    other = case.folder / "other"
    other.mkdir()
    members, strangers = stay_apart(case, fleet_keys.make(case.rabit, other, STRANGERS))
    for node in (*members, *strangers):
        node.says(OTHER_KEYS)
    check_apart(case, members, strangers)


def recordings(case):
    """recordings of a member that has ended, and then starts anew"""
    first, second = case.talkers(*MEMBERS)
    first.wait_for("tick from=hushed1 .*", RECORDED)
    second.process.kill()
    first.wait_for("peer node=hushed1 state=LOST .*")
    before = len(first.lines())
    recorded, mouth = 2 * list(case.seen), loopback.mouth()
    for _, port, datagram in recorded:
        for address in ("127.0.0.1", "239.255.0.1"):
            try:
                mouth.sendto(datagram, (address, port))
            except ConnectionRefusedError:  # of the datagram before: the member that has ended had that port
                mouth.sendto(datagram, (address, port))
    again = case.node("hushed1")
    first.wait_for("peer node=hushed1 state=UP .*", 1)
    first.wait_for("tick from=hushed1 .*", len(first.find("tick from=hushed1 .*")) + 20)
    begun, since = again.events()[0][0], first.events()[before:]
    heard = ("peer node=hushed1 state=UP", "tick from=hushed1 ", "delivered from=hushed1 ")
    early = [text for when, text in since if when < begun and text.startswith(heard)]
    numbers = [int(match[1]) for _, text in since if (match := re.match(r"tick from=hushed1 number=(\d+)", text))]
    assert not early, f"recordings were believed: {early[:3]}"
    assert numbers == sorted(numbers), f"a recording came among the ticks {numbers}"
    old = re.search(r"life=(\d+)", second.find("start .*")[0])[1]
    late = [text for _, text in since if text.startswith(f"delivered from=hushed1 life={old} ")]
    assert not late, f"recordings were delivered: {late[:3]}"


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace_or_skip()
    pair = (transports * 2)[:2]
    fleets = [dict(zip(MEMBERS, pair)) | dict.fromkeys(STRANGERS, stranger) for stranger in transports]
    wanted = [(act, fleet) for act in (no_keys, other_keys) for fleet in fleets]
    wanted += [(recordings, dict(zip(MEMBERS, order))) for order in (pair, pair[::-1])]
    cases = [Case(programs, harness.domain() + 3 * i, fleet, act) for i, (act, fleet) in enumerate(wanted)]

    def seen(source, destination, datagram):
        for case in cases:
            if loopback.is_in(case.domain, destination):
                case.seen.append((source, destination, bytes(datagram)))
    loopback.Watch(seen)
    sys.exit(1 if keyed_fleet.run(cases) else 0)


if __name__ == "__main__":
    main()
