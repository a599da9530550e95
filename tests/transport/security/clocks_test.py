#!/usr/bin/env python3
"""Whole nodes with keys whose wall clocks are wrong: uav1 is ten minutes slow, uav2 an hour fast. Right after the keys are
made, and right after another node is revoked, each hears the others and their queue messages arrive.

Usage: clocks_test.py RABIT LEDGER_NODE STEPPED_CLOCK TRANSPORT...
STEPPED_CLOCK is the library that sets the wall clock of a program (../../integration/stepped_clock.c)."""

import pathlib
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
from stolen_key_test import Case, Node, meet  # noqa: E402

SLOW_S, FAST_S = -600, 3600


def start(case, name, step_s, *options):
    clock = case.folder / f"{name}.clock"
    clock.write_bytes(struct.pack("=q", step_s))
    return Node(case, name, case.transports[name], "--keys", case.folder / "keys" / name, "--count", 100, "--rate", 20,
                *options, env={"LD_PRELOAD": case.stepped_clock, "STEPPED_CLOCK": str(clock)})


def fly(case):
    """right after the keys were made"""
    ground = start(case, "ground", 0, "--to", "uav1", "--to", "uav2")
    slow = start(case, "uav1", SLOW_S, "--to", "ground", "--to", "uav2")
    fast = start(case, "uav2", FAST_S, "--to", "ground", "--to", "uav1")
    meet(ground, slow, fast)
    for receiver in (ground, slow, fast):
        for sender in {ground, slow, fast} - {receiver}:
            receiver.wait_for(f"delivered from={sender.name} .*", 20)


def fly_after_revoking(case):
    """right after another node was revoked"""
    case.run_keys("revoke", "uav3", "--keys", case.folder / "keys")
    fly(case)


def main():
    programs, stepped_clock, transports = sys.argv[1:3], sys.argv[3], sys.argv[4:]
    harness.enter_namespace()
    fleets = [{"ground": first, "uav1": second, "uav2": second, "uav3": first}
              for first, second in zip(transports, reversed(transports))]
    failures = 0
    for act in (fly, fly_after_revoking):
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
