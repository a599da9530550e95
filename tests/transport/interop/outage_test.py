#!/usr/bin/env python3
"""A network that vanishes, and an address that changes, while two nodes run, for each pair of backends: the nodes live on, say
what they see, find each other within ten seconds of the network's return, and the queue links lose nothing.

Usage: outage_test.py NODE TRANSPORT...
Needs to make network namespaces; ends with 77 where it may not."""

import pathlib
import re
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import namespace  # noqa: E402
from namespace import harness, Holder  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
RECOVERY_S = 10
ORDERS = 100000  # more than come, so that orders are always under way
RATE = 50


class Case:
    """Two nodes, each in a namespace of its own, and one thing that happens to the first one's end of the cable."""

    def __init__(self, node, transports, event):
        self.node, self.transports, self.event = node, transports, event
        self.failure = None
        self.recovered = None

    def run(self):
        ends = [Holder(), Holder()]
        try:
            with harness.Processes() as processes, harness.Waits(processes.pids) as waits:
                self.check(ends, processes, waits)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)
        finally:
            for end in ends:
                end.close()

    def check(self, ends, processes, waits):
        self.connect(ends)
        names = ("first", "second")
        nodes = [processes.start([*ends[i].inside(), self.node, "--node", names[i], "--other", names[1 - i],
                                  "--transport", self.transports[i], "--interface", "eth0", "--count", ORDERS,
                                  "--rate", RATE, "--no-frame"]) for i in (0, 1)]
        for node in nodes:
            node.wait_for(re.compile(r"mirror life=\d+").fullmatch, LIMIT_S)
            node.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
        before = time.monotonic()
        self.take_away(ends)
        for node in nodes:
            node.wait_for(re.compile("peer LOST").fullmatch, LIMIT_S, before)
        time.sleep(2)  # longer than any lease
        # On a slow machine the nodes may meet before the last command has returned.
        back = time.monotonic()
        self.give_back(ends)
        for node in nodes:
            up, _ = node.wait_for(re.compile("peer UP").fullmatch, LIMIT_S, back)
            mirrored, _ = node.wait_for(re.compile(r"resumed life=\d+ after_s=.*").fullmatch, LIMIT_S, back)
            self.recovered = max(self.recovered or 0.0, up - back, mirrored - back)
        if self.recovered - waits.between(back, back + self.recovered) > RECOVERY_S:
            raise AssertionError(f"recovered {self.recovered:.1f} s after the network's return")
        for node in nodes:
            node.wait_for(re.compile("hundred orders round=1").fullmatch, LIMIT_S, back + self.recovered)
        for node in nodes:
            wrong = [text for _, text in node.lines
                     if re.search("not in order|skipped round|in doubt|garbled|^lost", text)]
            if wrong:
                raise AssertionError(f"{node.argv} said: {wrong[0]}")
            if not node.running():
                raise AssertionError(f"{node.argv} ended")
        for node in nodes:
            code = node.terminate()
            if code != 0:
                raise AssertionError(f"{node.argv} ended with {code}")

    def connect(self, ends):
        first, second = ends
        first.run("ip", "link", "add", "eth0", "type", "veth", "peer", "name", "eth0", "netns",
                  str(second.process.pid))
        for number, end in enumerate(ends, start=1):
            end.run("ip", "link", "set", "lo", "up")
            end.run("ip", "address", "add", f"10.77.0.{number}/24", "dev", "eth0")
            end.run("ip", "link", "set", "eth0", "up")
            end.run("ip", "route", "add", "224.0.0.0/4", "dev", "eth0")

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
        outcome = f"recovered in {case.recovered:.1f} s" if case.failure is None else f"FAILED: {case.failure}"
        print(f"{case.transports[0]:<11} {case.transports[1]:<11} {case.event:<8} {outcome}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
