#!/usr/bin/env python3
"""Processes that stop for longer than every lease and go on, and networks that let packets through one way alone, for each
pair of backends: within ten seconds the nodes are together again, and each order has been delivered once.

Usage: suspension_test.py NODE SECONDS TRANSPORT...   (SECONDS: how long the nodes are stopped or deaf, by commas)
Needs to make network namespaces; ends with 77 where it may not."""

import os
import pathlib
import re
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
from outage_test import Holder  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
RECOVERY_S = 10
RATE = 20
NAMES = ("first", "second")
TOGETHER = re.compile(r"settled round=1 delivered=(\d+) in_doubt=(\d+)")
WRONG = re.compile("not in order|skipped round|in doubt|garbled|^lost")


class Stop:
    """SIGSTOP and SIGCONT for one of two nodes or for both."""

    def __init__(self, *which):
        self.which = which

    def __str__(self):
        return "stop " + " and ".join(NAMES[i] for i in self.which)

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
        return "deaf " + " and ".join(NAMES[i] for i in self.which)

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
        # Enough that some are sent only after the event, however slow this machine is.
        self.count = int(RATE * (seconds + 8))
        self.failure = None
        self.recovered = 0.0
        self.nodes = []

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
        self.nodes = [processes.start([*ends[i].inside(), self.node, "--node", NAMES[i], "--other", NAMES[1 - i],
                                       "--transport", self.transports[i], "--interface", "eth0", "--count", self.count,
                                       "--rate", RATE, "--no-frame"]) for i in (0, 1)]
        last_sent = {}
        for node in self.nodes:
            node.wait_for(re.compile(r"mirror life=\d+").fullmatch, LIMIT_S)
            up, _ = node.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
            last_sent[node] = up + self.count / RATE
        time.sleep(1)  # orders are on their way
        self.event.begin(ends, self.nodes)
        time.sleep(self.seconds)
        self.event.end(ends, self.nodes)
        back = time.monotonic()
        for node in self.nodes:
            settled, found = node.wait_for(TOGETHER.fullmatch, LIMIT_S)
            if found.groups() != (str(self.count), "0"):
                raise AssertionError(f"{node.argv} said: {found.group()}")
            self.note(max(back, last_sent[node]), settled, waits)
        for node in self.nodes:  # what came out of a buffer alone is no recovery
            self.follow_counters(node)
            self.note(back, max((when for when, text in node.lines if re.match("resumed|peer", text)), default=0), waits)
            if [text for _, text in node.lines if text.startswith("peer")][-1] != "peer UP":
                raise AssertionError(f"{node.argv} does not see the other")
            wrong = [text for _, text in node.lines if WRONG.search(text)]
            if wrong:
                raise AssertionError(f"{node.argv} said: {wrong[0]}")
        if self.recovered > RECOVERY_S:
            raise AssertionError(f"recovered {self.recovered:.1f} s after the end")
        for node in self.nodes:
            code = node.terminate()
            if code != 0:
                raise AssertionError(f"{node.argv} ended with {code}")

    def follow_counters(self, node):
        since = time.monotonic()
        for _ in range(3):
            since, _ = node.wait_for(re.compile("ten counters").fullmatch, LIMIT_S, since)
            since += 0.001

    def note(self, begin, end, waits):
        """Without what the machine took."""
        if end > begin:
            self.recovered = max(self.recovered, end - begin - waits.between(begin, end))

    def connect(self, ends):
        first, second = ends
        first.run("ip", "link", "add", "eth0", "type", "veth", "peer", "name", "eth0", "netns",
                  str(second.process.pid))
        for number, end in enumerate(ends, start=1):
            end.run("ip", "link", "set", "lo", "up")
            end.run("ip", "address", "add", f"10.77.0.{number}/24", "dev", "eth0")
            end.run("ip", "link", "set", "eth0", "up")
            end.run("ip", "route", "add", "224.0.0.0/4", "dev", "eth0")


def cases(node, seconds, transports):
    pairs = [(a, b) for n, a in enumerate(transports) for b in transports[n:]]
    for pair in pairs:
        events = [Stop(0), Stop(0, 1), Deaf(0), Deaf(0, 1)]
        if pair[0] != pair[1]:
            events += [Stop(1), Deaf(1)]
        for event in events:
            yield Case(node, pair, event, seconds)


def main():
    node, seconds, transports = sys.argv[1], sys.argv[2], sys.argv[3:]
    if not harness.can_make_namespaces():
        harness.skip("no network namespace can be made")
    all_cases = [case for length in seconds.split(",") for case in cases(node, float(length), transports)]
    harness.run_at_once(all_cases)
    for case in all_cases:
        outcome = f"recovered in {case.recovered:.1f} s" if case.failure is None else f"FAILED: {case.failure}"
        print(f"{case.transports[0]:<11} {case.transports[1]:<11} {str(case.event):<22} {case.seconds:>5} s  {outcome}")
    sys.exit(1 if any(case.failure for case in all_cases) else 0)


if __name__ == "__main__":
    main()
