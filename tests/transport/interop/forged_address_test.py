#!/usr/bin/env python3
"""Somebody forges the first announcement of a participant that another one hears: that samples for it go to another port.
Samples that are written to it alone must reach it all the same, because its endpoints say where they are, in its card.

Usage: forged_address_test.py NODE TRANSPORT...
Needs root."""

import contextlib
import pathlib
import re
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import field  # noqa: E402
import harness  # noqa: E402
import wire as between  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 600
NODES = ("alpha", "bravo")
ORDERS = 100
DEFAULT_UNICAST_LOCATOR = 0x0031
NOBODYS_PORT = 9


class Case:
    """bravo hears nothing of alpha before the forged announcement."""

    def __init__(self, node, transports, number):
        self.node, self.transports, self.number = node, dict(zip(NODES, transports)), number
        self.wire = self.failure = None
        self.listens = False
        self.forged = 0

    def __str__(self):
        return "+".join(self.transports.values())

    def change(self, node, datagram):
        out = bytearray(datagram)
        for each in between.submessages(out):
            if node == "bravo":
                self.listens |= each.writer == between.ANNOUNCEMENT
            elif self.forged == 0 and each.writer == between.ANNOUNCEMENT and self.listens:
                found, order = between.parameters(out, each)
                for number, at, _ in found:
                    if number == DEFAULT_UNICAST_LOCATOR:
                        struct.pack_into(order + "I", out, at + 8, NOBODYS_PORT)
                        self.forged += 1
        return [out] if node == "bravo" or self.forged > 0 else []

    def run(self):
        try:
            self.wire.change = self.change
            self.exchange()
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def exchange(self):
        nodes = [self.wire.start(name, [self.node, "--node", name, "--other", self.wire.other(name), "--transport",
                                        transport, "--interface", "eth0", "--count", ORDERS, "--no-frame"])
                 for name, transport in self.transports.items()]
        for process in nodes:
            process.wait_for(re.compile(f"settled round=1 delivered={ORDERS} in_doubt=0").fullmatch, LIMIT_S)


def main():
    node, transports = sys.argv[1], sys.argv[2:]
    harness.enter_namespace()
    pairs = [(alpha, bravo) for alpha in transports for bravo in transports]
    cases = [Case(node, pair, number) for number, pair in enumerate(pairs)]
    with field.skipping():
        with contextlib.ExitStack() as wires:
            for case in cases:
                case.wire = wires.enter_context(between.Wire(NODES, case.number))
            harness.run_at_once(cases)
    for case in cases:
        print(f"{case}: {case.failure or 'delivered'}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
