#!/usr/bin/env python3
"""What somebody gets with the keys of a member, in a fleet of ground, uav1 and uav3: what that member may, in its name, and
nothing in another's. A thief that seals datagrams by itself says ticks and the goodbye of ground in each way that its keys
allow. Nobody obeys; uav1 and uav3 tell of each way, which also shows that the seals were right; and the others' traffic goes on.

Usage: stolen_keys_test.py RABIT LEDGER_NODE TRANSPORT...
Skipped (exit code 77) where no network namespace can be made, and without Python's package cryptography."""

import importlib.util
import re
import sys

import keyed_fleet
import loopback
from keyed_fleet import ENDLESS, LIMIT_S, exchange, harness, meet, once_and_in_order

if importlib.util.find_spec("cryptography") is None:
    harness.skip("Python's package cryptography is missing", "python3-cryptography")
import thief  # noqa: E402

NODES = ("ground", "uav1", "uav3")
# That a node left: one that falls silent was heard more than 3 s before it is LOST.
LEFT = r"peer node={} state=LOST heard_s=([0-2](\.\d+)?|\S+e-\d+)"


class Case(keyed_fleet.Case):
    thief = None

    def seen(self, destination, datagram):
        if self.thief and loopback.is_in(self.domain, destination):
            self.thief.seen(datagram)


def speak_as_ground(case, owner):
    case.thief = thief.Thief(case.folder / "keys" / owner, case.domain)
    _, uav1, uav3 = nodes = case.talkers(*NODES)

    def is_proven():
        case.thief.introduce()
        return case.thief.answered >= set(NODES)
    harness.until(is_proven, LIMIT_S)
    victim = harness.until(lambda: case.thief.of("ground"), LIMIT_S)
    harness.until(lambda: victim.ticks, LIMIT_S)
    rows = [re.escape(text) for text in ("its datagrams were made by another member than they say",
                                         "it sends in the name of other participants",
                                         f"{owner} claims an identity that ground has proven")]

    def are_told():
        case.thief.speak_as(victim)
        return all(node.find(f"problem .*{row}.*") for node in (uav1, uav3) for row in rows)
    harness.until(are_told, LIMIT_S)
    exchange(*nodes)
    once_and_in_order(*nodes)
    for node in nodes:
        node.never(f"tick .*number={thief.FORGED} .*", *(LEFT.format(other.name) for other in nodes))
    harness.until(lambda: all(node.state_of(other.name) == "UP" for node in nodes for other in nodes if other is not node), LIMIT_S)


def as_ground_with_the_keys_of_uav2(case):
    """somebody with the keys of uav2 speaks as ground"""
    speak_as_ground(case, "uav2")


def as_ground_with_the_keys_of_a_tool(case):
    """somebody with the keys of a tool speaks as ground"""
    case.run_keys("add", "laptop", "--tool", "--keys", case.folder / "keys")
    speak_as_ground(case, "laptop")


def as_uav2(case):
    """somebody with the keys of uav2 does what uav2 may"""
    uav1 = case.node("uav1", "--accept-from", "ground")
    ground = case.node("ground", "--to", "uav1", *ENDLESS)
    uav2 = case.node("uav2", "--to", "ground", "--to", "uav1", *ENDLESS)
    meet(uav1, ground, uav2)
    for pattern in ("delivered from=uav2 .*", "tick from=uav2 .*"):
        ground.wait_for(pattern, 10)
    uav2.wait_for("refused to=uav1 .*")
    uav2.says("accepts no messages of this node")
    uav1.wait_for("delivered from=ground .*", 10)
    uav1.never("delivered from=uav2 .*")


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace_or_skip()
    fleets = [{"ground": first, "uav1": second, "uav2": first, "uav3": first}
              for first in transports for second in transports]
    acts = (as_ground_with_the_keys_of_uav2, as_ground_with_the_keys_of_a_tool, as_uav2)
    wanted = [(act, fleet) for act in acts for fleet in fleets]
    cases = [Case(programs, harness.domain() + 3 * i, fleet, act) for i, (act, fleet) in enumerate(wanted)]

    def seen(_, destination, datagram):
        for case in cases:
            case.seen(destination, datagram)
    loopback.Watch(seen)
    failures = sum(keyed_fleet.run(cases[first:first + len(fleets)]) for first in range(0, len(cases), len(fleets)))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
