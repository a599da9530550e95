#!/usr/bin/env python3
"""Nodes whose wall clocks are wrong by months: one has its certificates not begun, one has them ended. They meet, exchange
messages, and tell of the certificates. So they do while the clock of one steps by years in flight, as GPS may set it.

Usage: clocks_test.py RABIT LEDGER_NODE STEPPED_CLOCK TRANSPORT...
STEPPED_CLOCK is the library that sets the wall clock of a program (gateway/lab/clock/stepped_clock.c)."""

import struct
import sys

import keyed_fleet
from keyed_fleet import exchange, harness, once_and_in_order

DAY_S = 24 * 60 * 60
# Certificates last for a year.
SLOW_S, FAST_S, YEARS_S = -120 * DAY_S, 480 * DAY_S, 3 * 365 * DAY_S
LIBRARY = sys.argv[3]


def set_clock(case, name, step_s):
    clock = case.folder / f"{name}.clock"
    clock.touch()
    with open(clock, "r+b") as file:  # the program maps it
        file.write(struct.pack("=q", step_s))
    return clock


def start(case, steps):
    """Nodes with their wall clocks so wrong, which send each other notes."""
    clocks = {name: set_clock(case, name, step_s) for name, step_s in steps.items()}
    return case.talkers(*steps, env_of=lambda name: {"LD_PRELOAD": LIBRARY, "STEPPED_CLOCK": str(clocks[name])})


def wrong_clocks(case):
    """clocks are wrong by months"""
    ground, slow, fast = nodes = start(case, {"ground": 0, "slow": SLOW_S, "fast": FAST_S})
    exchange(*nodes)
    for name in ("ground", "slow", "fast"):
        slow.says(f"the certificate of {name} begins on ")
        fast.says(f"the certificate of {name} ended on ")
    ground.never("problem .*certificate.*")
    once_and_in_order(*nodes)


def clock_that_steps_in_flight(case):
    """a clock steps by years in flight"""
    nodes = start(case, {"ground": 0, "slow": 0, "fast": 0})
    for step_s in (YEARS_S, 0, -YEARS_S, 0):
        set_clock(case, "slow", step_s)
        exchange(*nodes)
    for node in nodes:
        node.never("peer node=.* state=LOST .*")
    once_and_in_order(*nodes)


def main():
    programs, transports = sys.argv[1:3], sys.argv[4:]
    harness.enter_namespace()
    fleets = [{"ground": first, "slow": second, "fast": second} for first, second in zip(transports, reversed(transports))]
    wanted = [(act, fleet) for act in (wrong_clocks, clock_that_steps_in_flight) for fleet in fleets]
    cases = [keyed_fleet.Case(programs, harness.domain() + 3 * i, fleet, act) for i, (act, fleet) in enumerate(wanted)]
    sys.exit(1 if keyed_fleet.run(cases) else 0)


if __name__ == "__main__":
    main()
