#!/usr/bin/env python3
"""A network that vanishes, and an address that changes, while two nodes run, for each pair of backends: the nodes live on, say
what they see, find each other when the network returns, and the queue links lose nothing.

Usage: outage_test.py NODE TRANSPORT...
Needs to make network namespaces; ends with 77 where it may not."""

import pathlib
import re
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import namespace  # noqa: E402
import pair  # noqa: E402
from namespace import harness, Holder  # noqa: E402

LEASE_S = 2  # longer than any lease


class Case:
    """Two nodes, each in a namespace of its own, and one thing that happens to the first one's end of the cable."""

    def __init__(self, node, transports, event):
        self.node, self.transports, self.event = node, transports, event
        self.failure = None
        self.took = 0.0

    def run(self):
        ends = [Holder(), Holder()]
        try:
            with harness.Processes() as processes:
                pair.connect(*ends)
                nodes = pair.start(processes, self.node, ends, self.transports)
                before = time.monotonic()
                self.take_away(ends)
                for node in nodes:
                    node.wait_for(re.compile("peer LOST").fullmatch, pair.LIMIT_S, before)
                time.sleep(LEASE_S)
                back = time.monotonic()
                self.give_back(ends)
                for node in nodes:
                    node.wait_for(re.compile(r"resumed life=\d+ after_s=.*").fullmatch, pair.LIMIT_S, back)
                self.took = pair.await_both(nodes, back) - back
                pair.end(nodes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)
        finally:
            for end in ends:
                end.close()

    def take_away(self, ends):
        if self.event == "cable":
            ends[0].run("ip", "link", "set", "eth0", "down")
        else:
            ends[0].run("ip", "address", "flush", "dev", "eth0")

    def give_back(self, ends):
        if self.event == "cable":
            ends[0].run("ip", "link", "set", "eth0", "up")
        else:
            ends[0].run("ip", "address", "add", "10.77.0.9/24", "dev", "eth0")
        ends[0].run("ip", "route", "replace", "224.0.0.0/4", "dev", "eth0")


def main():
    node, transports = sys.argv[1], sys.argv[2:]
    if not namespace.supported():
        harness.skip("no network namespace can be made")
    cases = [Case(node, (first, second), event) for first in transports for second in transports
             for event in ("cable", "address")]
    harness.run_at_once(cases)
    for case in cases:
        outcome = f"together after {case.took:.1f} s" if case.failure is None else f"FAILED: {case.failure}"
        print(f"{case.transports[0]:<11} {case.transports[1]:<11} {case.event:<8} {outcome}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
