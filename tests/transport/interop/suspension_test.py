#!/usr/bin/env python3
"""Processes that stop for longer than every lease and go on, and networks that let packets through one way alone, for each
pair of backends: the nodes find together again, and each order is delivered once.

Usage: suspension_test.py NODE SECONDS TRANSPORT...   (SECONDS: how long the nodes are stopped or deaf, by commas)
Needs to make network namespaces; ends with 77 where it may not."""

import os
import pathlib
import signal
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import pair  # noqa: E402
from namespace import harness, Holder  # noqa: E402


class Stop:
    """SIGSTOP and SIGCONT for one of two nodes or for both."""

    def __init__(self, *which):
        self.which = which

    def __str__(self):
        return "stop " + " and ".join(pair.NAMES[i] for i in self.which)

    def begin(self, _ends, nodes):
        for i in self.which:
            os.kill(nodes[i].pid, signal.SIGSTOP)

    def end(self, _ends, nodes):
        for i in self.which:
            os.kill(nodes[i].pid, signal.SIGCONT)


class Deaf:
    """One of two nodes hears nothing, or both."""

    def __init__(self, *which):
        self.which = which

    def __str__(self):
        return "deaf " + " and ".join(pair.NAMES[i] for i in self.which)

    def begin(self, ends, _nodes):
        for i in self.which:
            ends[i].run("nft", "add table ip deaf; add chain ip deaf input { type filter hook input priority 0; policy drop; }")

    def end(self, ends, _nodes):
        for i in self.which:
            ends[i].run("nft", "delete table ip deaf")


class Case:
    """Two nodes, each in a namespace of its own, and one thing that happens to them."""

    def __init__(self, node, transports, event, seconds):
        self.node, self.transports, self.event, self.seconds = node, transports, event, seconds
        self.failure = None
        self.took = 0.0

    def run(self):
        ends = [Holder(), Holder()]
        try:
            with harness.Processes() as processes:
                pair.connect(*ends)
                nodes = pair.start(processes, self.node, ends, self.transports)
                self.event.begin(ends, nodes)
                time.sleep(self.seconds)
                self.event.end(ends, nodes)
                back = time.monotonic()
                self.took = pair.await_both(nodes, back) - back
                pair.end(nodes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)
        finally:
            for end in ends:
                end.close()


def cases(node, seconds, transports):
    for both in [(a, b) for n, a in enumerate(transports) for b in transports[n:]]:
        events = [Stop(0), Stop(0, 1), Deaf(0), Deaf(0, 1)]
        if both[0] != both[1]:
            events += [Stop(1), Deaf(1)]
        for event in events:
            yield Case(node, both, event, seconds)


def main():
    node, seconds, transports = sys.argv[1], sys.argv[2], sys.argv[3:]
    if not harness.can_make_namespaces():
        harness.skip("no network namespace can be made")
    all_cases = [case for length in seconds.split(",") for case in cases(node, float(length), transports)]
    harness.run_at_once(all_cases)
    for case in all_cases:
        outcome = f"together after {case.took:.1f} s" if case.failure is None else f"FAILED: {case.failure}"
        print(f"{case.transports[0]:<11} {case.transports[1]:<11} {str(case.event):<22} {case.seconds:>5} s  {outcome}")
    sys.exit(1 if any(case.failure for case in all_cases) else 0)


if __name__ == "__main__":
    main()
