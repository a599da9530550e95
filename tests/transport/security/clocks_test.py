#!/usr/bin/env python3
"""Whole nodes with keys whose wall clocks are wrong: uav1 is ten minutes slow, uav2 an hour fast. Right after the keys are
made, and right after another node is revoked, each hears the others and their queue messages arrive. So they do while the
clock of uav1 steps by years in flight, as GPS may set it.

Usage: clocks_test.py RABIT LEDGER_NODE STEPPED_CLOCK TRANSPORT...
STEPPED_CLOCK is the library that sets the wall clock of a program (../../integration/stepped_clock.c)."""

import pathlib
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
from stolen_key_test import Case, Node, meet, never  # noqa: E402

SLOW_S, FAST_S = -600, 3600
YEARS_S = 3 * 365 * 24 * 60 * 60  # longer than certificates are valid


def set_clock(case, name, step_s):
    clock = case.folder / f"{name}.clock"
    clock.touch()
    with open(clock, "r+b") as file:  # the program maps it
        file.write(struct.pack("=q", step_s))
    return clock


def start(case, steps):
    """ground, uav1 and uav2 with their wall clocks so wrong, which send each other notes."""
    nodes = []
    for name, step_s in steps.items():
        to = [word for other in steps.keys() - {name} for word in ("--to", other)]
        env = {"LD_PRELOAD": case.stepped_clock, "STEPPED_CLOCK": str(set_clock(case, name, step_s))}
        nodes.append(Node(case, name, case.transports[name], "--keys", case.folder / "keys" / name, "--count", 1000000,
                          "--rate", 20, *to, env=env))
    meet(*nodes)
    return nodes


def exchange(nodes):
    """Each gets another 20 notes of each."""
    before = {}
    for receiver in nodes:
        for sender in nodes:
            before[receiver, sender] = len(receiver.find(f"delivered from={sender.name} .*"))
    for receiver in nodes:
        for sender in nodes:
            if sender is not receiver:
                receiver.wait_for(f"delivered from={sender.name} .*", before[receiver, sender] + 20)


def wrong_clocks(case):
    """right after the keys were made"""
    exchange(start(case, {"ground": 0, "uav1": SLOW_S, "uav2": FAST_S}))


def wrong_clocks_after_revoking(case):
    """right after another node was revoked"""
    case.run_keys("revoke", "uav3", "--keys", case.folder / "keys")
    wrong_clocks(case)


def clock_that_steps_in_flight(case):
    """while its clock is set by years, to before the certificates begin and to after their end"""
    nodes = start(case, {"ground": 0, "uav1": 0, "uav2": 0})
    for step_s in (YEARS_S, 0, -YEARS_S, 0):
        set_clock(case, "uav1", step_s)
        exchange(nodes)
    for node in nodes:
        never(node, "peer node=.* state=LOST .*")


def main():
    programs, stepped_clock, transports = sys.argv[1:3], sys.argv[3], sys.argv[4:]
    harness.enter_namespace()
    fleets = [{"ground": first, "uav1": second, "uav2": second, "uav3": first}
              for first, second in zip(transports, reversed(transports))]
    failures = 0
    for act in (wrong_clocks, wrong_clocks_after_revoking, clock_that_steps_in_flight):
        cases = [Case(programs, harness.domain() + 3 * i, fleet, act, True) for i, fleet in enumerate(fleets)]
        for case in cases:
            case.stepped_clock = stepped_clock
        harness.run_at_once(cases)
        for case in cases:
            print(f"uav1 over {case.transports['uav1']}, {act.__doc__}: {case.failure or 'as it should be'}")
            failures += 1 if case.failure else 0
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
