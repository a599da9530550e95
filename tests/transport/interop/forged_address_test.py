#!/usr/bin/env python3
"""Somebody forges the first announcement of a participant: that samples for it go to another port. What is written to it
alone must reach it all the same, for its endpoints say where they are. Those of Cyclone DDS do not, so the participant is
one of Fast DDS.

Usage: forged_address_test.py NODE TRANSPORT...
TRANSPORTs are those of the other node. Needs root."""

import contextlib
import pathlib
import re
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "integration"), str(HERE.parent / "security")]
import field  # noqa: E402
import harness  # noqa: E402
import wire as between  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 60
NODES = ("alpha", "bravo")
ORDERS = 100
DEFAULT_UNICAST_LOCATOR = 0x0031
NOBODYS_PORT = 9
SKIPPED = 77


class Case:
    """Of alpha's announcements the first is forged."""

    def __init__(self, node, transports, number):
        self.node, self.transports, self.number = node, dict(zip(NODES, transports)), number
        self.wire = self.failure = None
        self.forged = 0

    def change(self, node, datagram):
        out = bytearray(datagram)
        for each in between.submessages(out):
            if node == "alpha" and self.forged == 0 and each.writer == between.ANNOUNCEMENT:
                found, order = between.parameters(out, each)
                for number, at, _ in found:
                    if number == DEFAULT_UNICAST_LOCATOR:
                        struct.pack_into(order + "I", out, at + 8, NOBODYS_PORT)
                        self.forged += 1
        return [out]

    def run(self):
        try:
            self.wire.change = self.change
            nodes = {name: self.wire.start(
                name, [self.node, "--node", name, "--other", self.wire.other(name), "--transport", transport,
                       "--interface", "eth0", "--count", ORDERS, "--no-frame"])
                     for name, transport in reversed(self.transports.items())}
            for process in nodes.values():
                process.wait_for(re.compile(f"settled round=1 delivered={ORDERS} in_doubt=0").fullmatch, LIMIT_S)
            if self.forged == 0:
                raise AssertionError("nothing was forged")
        except Exception as error:  # the others go on
            self.failure = str(error)


def main():
    node, transports = sys.argv[1], sys.argv[2:]
    harness.enter_namespace()
    cases = [Case(node, ("fastdds", bravo), number) for number, bravo in enumerate(transports)]
    try:
        with contextlib.ExitStack() as wires:
            for case in cases:
                case.wire = wires.enter_context(between.Wire(NODES, case.number))
            harness.run_at_once(cases)
    except field.Unsupported as reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    for case in cases:
        print(f"{'+'.join(case.transports.values())}: {case.failure or 'delivered'}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
